lumulus_test(furnace_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/furnace_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_photon ${CMAKE_DL_LIBS})
lumulus_test(free_path_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/free_path_test.cpp ${CMAKE_CURRENT_LIST_DIR}/albedo_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_photon ${CMAKE_DL_LIBS})
