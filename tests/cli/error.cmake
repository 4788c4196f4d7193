add_test(NAME cli.error COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/error_test.py
                                $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.error PROPERTIES TIMEOUT 300)
