lumulus_test(reference_slab_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_slab_test.cpp LINK lumulus_reference)
lumulus_test(reference_tracer_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_tracer_test.cpp LINK lumulus_reference)
lumulus_test(reference_sun_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_sun_test.cpp LINK lumulus_reference)
lumulus_test(reference_render_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_render_test.cpp
             LINK lumulus_reference TBB::tbb)
lumulus_test(reference_fog_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_fog_test.cpp LINK lumulus_reference)
lumulus_test(reference_fog_layers_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_fog_layers_test.cpp
             LINK lumulus_reference)
lumulus_test(reference_foggy_air_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_foggy_air_test.cpp
             LINK lumulus_reference)
lumulus_test(reference_surface_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_surface_test.cpp LINK lumulus_reference)
lumulus_test(reference_lamp_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_lamp_test.cpp LINK lumulus_reference)
lumulus_test(reference_clouds_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_clouds_test.cpp LINK lumulus_reference)
lumulus_test(reference_ground_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_ground_test.cpp LINK lumulus_reference)
lumulus_test(reference_many_clouds_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_many_clouds_test.cpp
             LINK lumulus_reference)
lumulus_test(reference_error_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_error_test.cpp LINK lumulus_reference)
lumulus_test(reference_air_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_air_test.cpp LINK lumulus_reference)
lumulus_test(reference_map_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/reference_map_test.cpp LINK lumulus_reference)
