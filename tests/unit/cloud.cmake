lumulus_test(kdtree_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/kdtree_test.cpp ${CMAKE_CURRENT_LIST_DIR}/kdtree_shape_test.cpp
             LINK lumulus_cloud TBB::tbb)
