lumulus_test(renderer_test SANITIZED
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/renderer_beside_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_clouds_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_coarse_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_droplets_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_edited_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_fog_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_ground_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_passes_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_picture_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_sparse_sampling_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_swapped_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/renderer_views_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/shown_densities_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
lumulus_test(renderer_atmosphere_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/renderer_atmosphere_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
lumulus_test(renderer_map_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/renderer_map_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_reference lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
lumulus_test(renderer_moon_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/renderer_moon_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_reference lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
lumulus_test(renderer_lit_fog_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/renderer_lit_fog_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_fog_light lumulus_render lumulus_base lumulus_vdb ${CMAKE_DL_LIBS})
