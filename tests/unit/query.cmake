lumulus_test(query_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/query_clouds_test.cpp ${CMAKE_CURRENT_LIST_DIR}/query_media_test.cpp
  LINK lumulus_query lumulus_reference)
