find_package(spirv_cross_core CONFIG REQUIRED)
lumulus_test(shared_layout_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/shared_layout_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/support/struct_layout.cpp
  LINK lumulus_gpu lumulus_cloud_shaders lumulus_light_shaders lumulus_photon_shaders lumulus_draw_shaders lumulus_fog_shaders lumulus_frame_shaders lumulus_lit_fog_shaders lumulus_mesh_shaders lumulus_gpu_test_shaders
       spirv-cross-core)
