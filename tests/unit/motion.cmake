lumulus_test(motion_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/motion_test.cpp LINK lumulus_volume)
