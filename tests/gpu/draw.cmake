lumulus_test(draw_gpu_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/billboards_test.cpp ${CMAKE_CURRENT_LIST_DIR}/light_field_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/shadow_volume_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_draw ${CMAKE_DL_LIBS})
