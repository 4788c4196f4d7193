lumulus_test(bench_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/bench_curve_test.cpp ${CMAKE_CURRENT_LIST_DIR}/bench_plan_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/bench_record_test.cpp ${CMAKE_CURRENT_LIST_DIR}/bench_measure_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/bench_plot_test.cpp ${CMAKE_CURRENT_LIST_DIR}/bench_peer_test.cpp
  LINK lumulus_base lumulus_bench PNG::PNG)
lumulus_test(shipped_scenes_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/shipped_scenes_test.cpp
                                 LINK lumulus_view lumulus_scene lumulus_test_rico lumulus_vdb lumulus_volume)
target_compile_definitions(shipped_scenes_test PRIVATE LUMULUS_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
