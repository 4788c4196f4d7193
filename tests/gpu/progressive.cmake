lumulus_test(progressive_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/progressive_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_progressive lumulus_vdb ${CMAKE_DL_LIBS})
