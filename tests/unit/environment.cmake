lumulus_test(environment_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/environment_test.cpp LINK lumulus_sky)
