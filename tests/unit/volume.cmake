lumulus_test(volume_load_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/volume_load_test.cpp
                                      ${CMAKE_CURRENT_LIST_DIR}/volume_summary_test.cpp LINK lumulus_volume)
