lumulus_test(fog_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/fog_depth_test.cpp ${CMAKE_CURRENT_LIST_DIR}/fog_media_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/fog_pyramid_test.cpp
  LINK lumulus_fog)
lumulus_test(fog_light_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/air_over_fog_test.cpp ${CMAKE_CURRENT_LIST_DIR}/fog_light_test.cpp
  LINK lumulus_fog_light)
