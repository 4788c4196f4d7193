lumulus_test(frame_gpu_test SANITIZED
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/frame_test.cpp ${CMAKE_CURRENT_LIST_DIR}/fog_frame_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_fog lumulus_frame ${CMAKE_DL_LIBS})
