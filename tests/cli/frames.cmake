add_test(NAME cli.frames COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/frames_test.py $<TARGET_FILE:lumulus>
                                 $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.frames PROPERTIES TIMEOUT 300)
