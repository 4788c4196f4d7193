lumulus_test(emission_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/emission_test.cpp LINK lumulus_photon)
