find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(class Reference Compare Slab Bench)
  add_test(NAME cli.truth.${class} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/truth_test.py
                                           $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures> ${class})
  set_tests_properties(cli.truth.${class} PROPERTIES TIMEOUT 300)
endforeach()

# The full check takes minutes: scripts/slab_table.py --help. Here the script itself is run.
add_test(NAME cli.truth.slab_table COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/slab_table.py --random 3
                                           --photons 20000 --seeds 2 --lumulus $<TARGET_FILE:lumulus>)
set_tests_properties(cli.truth.slab_table PROPERTIES TIMEOUT 300)
