lumulus_test(frame_renderer_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/frame_renderer_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_job lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
