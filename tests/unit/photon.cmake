lumulus_test(emission_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/emission_test.cpp LINK lumulus_photon)
lumulus_test(map_limits_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/map_limits_test.cpp LINK lumulus_base lumulus_photon)
