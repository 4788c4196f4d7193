find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME cli.progressive COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/progressive_test.py
                                      $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.progressive PROPERTIES TIMEOUT 300)
