foreach(class Resume Light Files)
  add_test(NAME cli.transfer.${class} COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/transfer_test.py
                                              $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures> ${class})
  set_tests_properties(cli.transfer.${class} PROPERTIES TIMEOUT 300)
endforeach()
