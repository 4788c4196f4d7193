add_test(NAME cli.fog_truth COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/fog_truth_test.py
                                    $<TARGET_FILE:lumulus>)
set_tests_properties(cli.fog_truth PROPERTIES TIMEOUT 300)
