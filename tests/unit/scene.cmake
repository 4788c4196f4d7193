lumulus_test(scene_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/scene_load_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_schema_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_hostile_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_fog_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_surface_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_clouds_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_atmosphere_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_time_test.cpp ${CMAKE_CURRENT_LIST_DIR}/ephemeris_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_field_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_places_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scene_lamp_test.cpp
  LINK lumulus_scene)
target_compile_definitions(scene_test PRIVATE SOURCE_ROOT="${CMAKE_CURRENT_LIST_DIR}/../..")
lumulus_test(scene_ground_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/scene_ground_test.cpp LINK lumulus_scene)
lumulus_test(scene_map_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/scene_map_test.cpp LINK lumulus_scene)
