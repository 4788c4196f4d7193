# Debian's interpreter: python3-numpy belongs to it, whatever else is on the path.
find_program(DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
add_test(NAME cli.fog_truth COMMAND ${DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/fog_truth_test.py
                                    $<TARGET_FILE:lumulus>)
set_tests_properties(cli.fog_truth PROPERTIES TIMEOUT 300)
