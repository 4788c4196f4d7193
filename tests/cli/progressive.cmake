add_test(NAME cli.progressive COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/progressive_test.py
                                      $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.progressive PROPERTIES TIMEOUT 300)
