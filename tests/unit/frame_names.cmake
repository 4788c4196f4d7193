lumulus_test(frame_names_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/frame_names_test.cpp LINK lumulus_job)
