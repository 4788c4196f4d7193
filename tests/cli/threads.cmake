add_test(NAME cli.threads COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/threads_test.py
                                  $<TARGET_FILE:lumulus>)
set_tests_properties(cli.threads PROPERTIES TIMEOUT 300)
