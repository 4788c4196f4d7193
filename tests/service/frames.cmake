lumulus_test(frame_service_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cloud_edits_test.cpp ${CMAKE_CURRENT_LIST_DIR}/config_test.cpp ${CMAKE_CURRENT_LIST_DIR}/frame_parts_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/density_test.cpp ${CMAKE_CURRENT_LIST_DIR}/encoder_pool_test.cpp ${CMAKE_CURRENT_LIST_DIR}/exposure_desk_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/half_pixels_test.cpp ${CMAKE_CURRENT_LIST_DIR}/handler_times_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/http_replies_test.cpp ${CMAKE_CURRENT_LIST_DIR}/replies_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/load_queue_test.cpp ${CMAKE_CURRENT_LIST_DIR}/media_source_test.cpp ${CMAKE_CURRENT_LIST_DIR}/pending_changes_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/resources_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_list_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scheduler_test.cpp ${CMAKE_CURRENT_LIST_DIR}/upload_test.cpp
  LINK lumulus_photon lumulus_protocol lumulus_service lumulus_base OpenEXR::OpenEXR)
target_compile_definitions(frame_service_test PRIVATE LUMULUS_CONFIGS="${CMAKE_SOURCE_DIR}/configs")
