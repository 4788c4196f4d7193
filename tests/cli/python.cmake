# The Python module, where it is built (src/python/CMakeLists.txt).
if(TARGET lumulus_python)
  set(python_test ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/python_test.py $<TARGET_FILE:lumulus>
                  $<TARGET_FILE:make_vdb_fixtures> ${CMAKE_BINARY_DIR}/python)
  add_test(NAME cli.python COMMAND ${python_test} Pictures Stubs Example)
  add_test(NAME cli.python_errors COMMAND ${python_test} Errors)
  add_test(NAME cli.python_arrays COMMAND ${python_test} Densities)
  add_test(NAME cli.python_threads COMMAND ${python_test} Threads)
  set_tests_properties(cli.python cli.python_errors cli.python_arrays cli.python_threads PROPERTIES TIMEOUT 300)
endif()
