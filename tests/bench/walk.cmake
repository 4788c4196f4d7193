# Not a test: `build/release/tests/walk_bench SCENE` prints how fast the GPU's photon walk is against a plain C++ one.
add_executable(walk_bench ${CMAKE_CURRENT_LIST_DIR}/walk_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/plain_walk.cpp
                          ${CMAKE_CURRENT_LIST_DIR}/machine_peaks.cpp)
target_include_directories(walk_bench PRIVATE ${CMAKE_SOURCE_DIR}/tests)
# for the machine it runs on, as lavapipe's shaders are
target_compile_options(walk_bench PRIVATE $<$<CONFIG:Release>:-O3 -march=native -fno-math-errno -fno-trapping-math>)
target_link_libraries(walk_bench PRIVATE lumulus_options lumulus_photon lumulus_volume TBB::tbb fmt::fmt)
