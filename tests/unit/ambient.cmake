lumulus_test(ambient_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/ambient_test.cpp LINK lumulus_render)
