lumulus_test(tiles_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/tiles_test.cpp LINK lumulus_draw)
lumulus_test(lattice_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/lattice_test.cpp LINK lumulus_draw)
