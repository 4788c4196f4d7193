find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME cli.composite COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/composite_test.py
                                    $<TARGET_FILE:lumulus>)
set_tests_properties(cli.composite PROPERTIES TIMEOUT 300)
