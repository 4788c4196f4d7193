lumulus_test(material_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/material_test.cpp LINK lumulus_material)
