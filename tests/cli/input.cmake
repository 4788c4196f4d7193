add_test(NAME cli.input COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/input_test.py $<TARGET_FILE:lumulus>
                                $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.input PROPERTIES TIMEOUT 300)
