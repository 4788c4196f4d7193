if(TARGET lumulus_python)
  add_test(NAME cli.package COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/package_test.py ${CMAKE_BINARY_DIR})
  set_tests_properties(cli.package PROPERTIES TIMEOUT 300)
endif()
