lumulus_test(camera_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/camera_test.cpp ${CMAKE_CURRENT_LIST_DIR}/ground_below_clouds_test.cpp
  LINK lumulus_view)
