lumulus_test(photon_gpu_test SANITIZED
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/photon_ring_test.cpp ${CMAKE_CURRENT_LIST_DIR}/photon_store_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_photon ${CMAKE_DL_LIBS})
