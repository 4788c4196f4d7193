lumulus_shaders(lumulus_maths_test_shaders stat/shaders/evaluate_sh.comp stat/shaders/sample_hg.comp)

lumulus_test(maths_gpu_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/hg_sampler_test.cpp ${CMAKE_CURRENT_LIST_DIR}/sh_gpu_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_gpu lumulus_medium lumulus_maths_test_shaders ${CMAKE_DL_LIBS})
