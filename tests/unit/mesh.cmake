lumulus_test(mesh_gltf_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/mesh_gltf_test.cpp
             LINK lumulus_mesh nlohmann_json::nlohmann_json)
lumulus_test(bvh_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/bvh_test.cpp LINK lumulus_bvh)
lumulus_test(reference_mesh_test SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/stat/reference_mesh_test.cpp
             LINK lumulus_reference lumulus_bvh nlohmann_json::nlohmann_json)
