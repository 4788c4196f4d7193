# corpus_test(NAME [SOURCES …] LINK …): replays the inputs of corpus/NAME.tar.xz, which scripts/fuzz.sh NAME found, into
# the feed() of NAME_input.h.
function(corpus_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  set(archive ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/corpus/${name}.tar.xz)
  set(inputs ${CMAKE_BINARY_DIR}/corpus/${name})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${archive})
  file(REMOVE_RECURSE ${inputs})
  file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${inputs})
  lumulus_test(${name}_corpus_test SOURCES ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/corpus_test.cpp ${ARG_SOURCES}
               LINK ${ARG_LINK})
  target_compile_definitions(${name}_corpus_test PRIVATE LUMULUS_CORPUS="${inputs}"
                                                         LUMULUS_FUZZ_INPUT="fuzz/${name}_input.h")
endfunction()

corpus_test(chunks LINK lumulus_protocol lumulus_service_render lumulus_base)
corpus_test(exr LINK lumulus_base)
corpus_test(gltf LINK lumulus_mesh)
corpus_test(scene LINK lumulus_scene)
corpus_test(session SOURCES ${CMAKE_CURRENT_LIST_DIR}/session_lengths_test.cpp LINK lumulus_protocol lumulus_base)
corpus_test(vdb SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/vdb_throwing_new.cpp LINK lumulus_vdb)
