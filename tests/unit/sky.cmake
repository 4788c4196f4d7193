lumulus_test(sky_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sky_test.cpp LINK lumulus_draw)
