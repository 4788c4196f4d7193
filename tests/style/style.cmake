# Rules of the house that a machine can check: who links whom, sizes of files and functions, the words of comments and
# documents.
find_program(DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
foreach(subject arrows parser sizes words)
  add_test(NAME style.${subject} COMMAND ${DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/${subject}_test.py)
  set_tests_properties(style.${subject} PROPERTIES LABELS style TIMEOUT 60)
endforeach()
