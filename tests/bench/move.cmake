# Not a test: `build/release/tests/move_bench SCENE` prints what a camera move costs against a sample of the path tracer.
add_executable(move_bench ${CMAKE_CURRENT_LIST_DIR}/move_bench.cpp)
target_include_directories(move_bench PRIVATE ${CMAKE_SOURCE_DIR}/tests)
target_link_libraries(move_bench PRIVATE lumulus_options lumulus_reference lumulus_render lumulus_volume fmt::fmt)
