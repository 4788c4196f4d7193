lumulus_test(protocol_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/message_test.cpp ${CMAKE_CURRENT_LIST_DIR}/requests_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/session_test.cpp
  LINK lumulus_protocol lumulus_base)
