lumulus_test(environment_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/environment_test.cpp LINK lumulus_sky)
lumulus_test(atmosphere_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/atmosphere_test.cpp ${CMAKE_CURRENT_LIST_DIR}/atmosphere_balance_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/colour_matrix_test.cpp ${CMAKE_CURRENT_LIST_DIR}/harmonics_test.cpp
  LINK lumulus_sky)
lumulus_test(sky_view_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sky_view_test.cpp LINK lumulus_photon lumulus_sky)
lumulus_test(sky_return_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sky_return_test.cpp LINK lumulus_photon)
