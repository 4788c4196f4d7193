# Not a test: `build/release/tests/prefilter_bench` compares ways to prefilter a sky in one run (docs/environment.md).
add_executable(prefilter_bench ${CMAKE_CURRENT_LIST_DIR}/prefilter_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/texel_sum.cpp)
target_include_directories(prefilter_bench PRIVATE ${CMAKE_SOURCE_DIR}/tests)
# both sides as fast as the compiler makes them
target_compile_options(prefilter_bench PRIVATE $<$<CONFIG:Release>:-O3 -march=native -fno-math-errno -fno-trapping-math>)
target_link_libraries(prefilter_bench PRIVATE lumulus_options lumulus_prefilter lumulus_sky OpenEXR::OpenEXR TBB::tbb fmt::fmt)
