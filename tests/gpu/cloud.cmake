lumulus_test(cloud_gpu_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cloud_leaves_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cloud_majorant_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/prepare_check_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_cloud ${CMAKE_DL_LIBS})
