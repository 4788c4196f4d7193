lumulus_test(many_unit_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/entry_discs_test.cpp ${CMAKE_CURRENT_LIST_DIR}/level_of_detail_test.cpp ${CMAKE_CURRENT_LIST_DIR}/refined_test.cpp
  LINK lumulus_photon lumulus_cloud)
