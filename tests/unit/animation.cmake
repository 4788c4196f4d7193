lumulus_test(animation_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/animation_test.cpp LINK lumulus_scene)
