lumulus_test(file_sequence_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/file_sequence_test.cpp LINK lumulus_scene)
