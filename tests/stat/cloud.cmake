lumulus_test(gradient_sampling_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/gradient_sampling_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_cloud ${CMAKE_DL_LIBS})
