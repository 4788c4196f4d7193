lumulus_test(pass_stage_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/pass_stage_test.cpp LINK lumulus_render lumulus_base)
