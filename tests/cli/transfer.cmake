add_test(NAME cli.transfer COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/transfer_test.py $<TARGET_FILE:lumulus>
                                   $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.transfer PROPERTIES TIMEOUT 300)
