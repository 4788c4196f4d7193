lumulus_test(prefilter_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/prefilter_test.cpp ${CMAKE_CURRENT_LIST_DIR}/prefilter_layouts_test.cpp
          ${CMAKE_CURRENT_SOURCE_DIR}/bench/texel_sum.cpp
  LINK lumulus_prefilter lumulus_sky TBB::tbb OpenEXR::OpenEXR)
