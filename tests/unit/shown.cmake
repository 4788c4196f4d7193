lumulus_test(shown_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/shown_test.cpp LINK lumulus_draw)
