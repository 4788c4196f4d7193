# What made clear_sky_values.h; not a test.
add_executable(clear_sky_reference ${CMAKE_CURRENT_LIST_DIR}/clear_sky_reference.cpp)
target_include_directories(clear_sky_reference PRIVATE ${CMAKE_SOURCE_DIR}/tests)
target_link_libraries(clear_sky_reference PRIVATE lumulus_options lumulus_reference TBB::tbb fmt::fmt)

lumulus_test(clear_sky_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/clear_sky_test.cpp LINK lumulus_sky fmt::fmt)
