add_executable(make_vdb_fixtures ${CMAKE_CURRENT_LIST_DIR}/../support/make_vdb_fixtures.cpp)
target_compile_options(make_vdb_fixtures PRIVATE $<$<CONFIG:Release>:-O0>)
target_link_libraries(make_vdb_fixtures PRIVATE lumulus_options OpenVDB::openvdb)
foreach(class Usage Scene Volumes Places Rendering)
  add_test(NAME cli.${class} COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/../cli/cli_test.py
                                     $<TARGET_FILE:lumulus> $<TARGET_FILE:make_vdb_fixtures> ${class})
  set_tests_properties(cli.${class} PROPERTIES TIMEOUT 300)
endforeach()

lumulus_test(cli_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cli_advice_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cli_layers_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/cli_stats_test.cpp
  LINK lumulus_cli lumulus_base lumulus_scene lumulus_vdb CLI11::CLI11 nlohmann_json::nlohmann_json)
