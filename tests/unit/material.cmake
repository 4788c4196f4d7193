lumulus_test(material_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/material_test.cpp ${CMAKE_CURRENT_LIST_DIR}/material_walk_test.cpp
  LINK lumulus_material)
