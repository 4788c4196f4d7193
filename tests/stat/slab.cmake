lumulus_test(slab_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/slab_test.cpp ${CMAKE_SOURCE_DIR}/tests/support/vulkan_main.cpp
             LINK lumulus_photon)
