set(environment_test ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/environment_test.py $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures>)
add_test(NAME cli.environment COMMAND ${environment_test} Maps)
add_test(NAME cli.environment_refusals COMMAND ${environment_test} Refusals)
set_tests_properties(cli.environment cli.environment_refusals PROPERTIES TIMEOUT 300)
