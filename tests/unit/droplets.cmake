lumulus_test(droplets_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/droplets_test.cpp LINK lumulus_reference lumulus_medium)
