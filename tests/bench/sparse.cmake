# Not tests: `build/release/tests/sparse_bench SCENE` prints what densities in bricks cost, `make_field` writes large ones.
add_executable(sparse_bench ${CMAKE_CURRENT_LIST_DIR}/sparse_bench.cpp)
target_include_directories(sparse_bench PRIVATE ${CMAKE_SOURCE_DIR}/tests)
target_link_libraries(sparse_bench PRIVATE lumulus_options lumulus_render lumulus_scene fmt::fmt)
add_executable(make_field ${CMAKE_CURRENT_LIST_DIR}/make_field.cpp)
target_link_libraries(make_field PRIVATE lumulus_options OpenVDB::openvdb TBB::tbb glm::glm)
