# Not a test: `build/release/tests/mesh_bench FILE.glb` compares our tree of triangles with Embree's (docs/meshes.md).
add_executable(mesh_bench ${CMAKE_CURRENT_LIST_DIR}/mesh_bench.cpp)
target_include_directories(mesh_bench PRIVATE ${CMAKE_SOURCE_DIR}/tests)
target_link_libraries(mesh_bench PRIVATE lumulus_options lumulus_bvh embree TBB::tbb fmt::fmt)
