lumulus_test(base_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/base_file_test.cpp ${CMAKE_CURRENT_LIST_DIR}/base_free_list_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/base_exr_claims_test.cpp ${CMAKE_CURRENT_LIST_DIR}/base_file_kind_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/base_image_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/base_text_test.cpp ${CMAKE_CURRENT_LIST_DIR}/tone_test.cpp
  LINK lumulus_base OpenEXR::OpenEXR PNG::PNG)
if(OpenColorIO_FOUND)
  target_compile_definitions(base_test PRIVATE LUMULUS_OPEN_COLOR_IO)
endif()
