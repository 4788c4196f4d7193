find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME cli.threads COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/threads_test.py
                                  $<TARGET_FILE:lumulus>)
set_tests_properties(cli.threads PROPERTIES TIMEOUT 300)
