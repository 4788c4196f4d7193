set(mesh_test ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/mesh_test.py $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures>)
add_test(NAME cli.mesh COMMAND ${mesh_test} Pictures)
add_test(NAME cli.mesh_refusals COMMAND ${mesh_test} Refusals)
set_tests_properties(cli.mesh cli.mesh_refusals PROPERTIES TIMEOUT 300)
