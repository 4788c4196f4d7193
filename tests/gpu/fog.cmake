lumulus_test(fog_gpu_test SANITIZED
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/fog_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_fog ${CMAKE_DL_LIBS})
