lumulus_test(bench_runs_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/bench_runs_test.cpp
                                     ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
             LINK lumulus_bench lumulus_reference lumulus_render lumulus_volume ${CMAKE_DL_LIBS})
