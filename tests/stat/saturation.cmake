lumulus_test(saturation_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/saturation_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_photon ${CMAKE_DL_LIBS})
