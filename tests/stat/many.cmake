lumulus_test(many_stat_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/many_clouds_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_photon ${CMAKE_DL_LIBS})
