lumulus_test(shared_layout_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/shared_layout_test.cpp
             LINK lumulus_gpu lumulus_cloud_shaders lumulus_photon_shaders lumulus_draw_shaders)
