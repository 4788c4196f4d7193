lumulus_test(bake_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/bake_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_bake lumulus_photon lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
