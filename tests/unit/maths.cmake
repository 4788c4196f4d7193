lumulus_test(rng_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/rng_test.cpp LINK lumulus_medium)
lumulus_test(phase_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/phase_sampling_test.cpp ${CMAKE_CURRENT_LIST_DIR}/phase_tables_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/phase_test.cpp ${CMAKE_CURRENT_LIST_DIR}/sun_axis_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/mie_test.cpp
  LINK lumulus_medium)
lumulus_test(sh_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sh_test.cpp LINK lumulus_medium)
lumulus_test(deviation_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/deviation_test.cpp)
