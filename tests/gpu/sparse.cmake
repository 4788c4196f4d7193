lumulus_test(sparse_gpu_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/sparse_density_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_render ${CMAKE_DL_LIBS})
