lumulus_test(sky_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sky_test.cpp LINK lumulus_draw)
lumulus_test(map_sky_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/map_sky_test.cpp LINK lumulus_reference lumulus_sky)
