foreach(class Words Help Pipes Threads)
  add_test(NAME cli.command_line.${class} COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/command_line_test.py
                                                  $<TARGET_FILE:lumulus> ${class})
  set_tests_properties(cli.command_line.${class} PROPERTIES TIMEOUT 300)
endforeach()
