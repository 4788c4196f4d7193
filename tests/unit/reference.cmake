lumulus_test(reference_phase_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_phase_test.cpp LINK lumulus_reference)
lumulus_test(reference_medium_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_medium_test.cpp LINK lumulus_reference)
lumulus_test(metrics_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/metrics_test.cpp LINK lumulus_reference)
lumulus_test(flip_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/flip_test.cpp LINK lumulus_reference)
lumulus_test(reference_fog_density_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_fog_density_test.cpp
             LINK lumulus_reference)
lumulus_test(reference_surfaces_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_surfaces_test.cpp
             LINK lumulus_reference)
lumulus_test(reference_air_path_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_air_path_test.cpp LINK lumulus_reference)
