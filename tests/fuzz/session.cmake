lumulus_test(session_corpus_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/session_corpus_test.cpp
  LINK lumulus_protocol lumulus_base)
target_compile_definitions(session_corpus_test PRIVATE LUMULUS_CORPUS="${CMAKE_CURRENT_LIST_DIR}/corpus/session")
