add_test(NAME cli.composite COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/composite_test.py
                                    $<TARGET_FILE:lumulus>)
set_tests_properties(cli.composite PROPERTIES TIMEOUT 300)
