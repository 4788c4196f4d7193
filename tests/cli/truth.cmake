foreach(class Reference AgainstTheReference Compare Slab Bench)
  add_test(NAME cli.truth.${class} COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/truth_test.py
                                           $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures> ${class})
  set_tests_properties(cli.truth.${class} PROPERTIES TIMEOUT 300)
endforeach()
