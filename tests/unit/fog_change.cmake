lumulus_test(fog_change_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/fog_change_test.cpp
  LINK lumulus_fog_change)
