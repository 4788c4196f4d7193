lumulus_test(carried_light_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/carried_light_test.cpp
             LINK lumulus_photon)
