lumulus_test(volume_load_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/volume_load_test.cpp
                                      ${CMAKE_CURRENT_LIST_DIR}/volume_summary_test.cpp LINK lumulus_volume)
lumulus_test(place_clouds_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/place_clouds_test.cpp LINK lumulus_volume)
lumulus_test(far_parts_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/far_parts_test.cpp LINK lumulus_volume OpenVDB::openvdb)
