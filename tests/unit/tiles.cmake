lumulus_test(tiles_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/tiles_test.cpp LINK lumulus_draw)
lumulus_test(sparse_sampling_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sparse_sampling_test.cpp LINK lumulus_draw)
