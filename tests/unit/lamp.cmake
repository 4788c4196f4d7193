lumulus_test(lamp_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/lamp_test.cpp LINK lumulus_lamp)
