lumulus_test(lit_cells_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/lit_cells_test.cpp LINK lumulus_draw)
