add_test(NAME cli.query COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/query_test.py
                                $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.query PROPERTIES TIMEOUT 300)
