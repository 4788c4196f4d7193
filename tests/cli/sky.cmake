add_test(NAME cli.sky COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/sky_test.py $<TARGET_FILE:lumulus>
                              $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.sky PROPERTIES TIMEOUT 300)
