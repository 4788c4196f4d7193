add_test(NAME cli.maps COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/maps_test.py $<TARGET_FILE:lumulus>
                               $<TARGET_FILE:make_vdb_fixtures>)
set_tests_properties(cli.maps PROPERTIES TIMEOUT 300)
