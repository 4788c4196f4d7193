add_test(NAME cli.colour COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/colour_test.py $<TARGET_FILE:lumulus>
                                 $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.colour PROPERTIES TIMEOUT 300)
