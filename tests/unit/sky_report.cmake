lumulus_test(sky_report_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sky_report_test.cpp LINK lumulus_sky)
