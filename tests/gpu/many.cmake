lumulus_test(many_test SANITIZED
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/many_shade_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
