add_library(lumulus_test_rico STATIC ${CMAKE_CURRENT_LIST_DIR}/../support/rico.cpp)
target_include_directories(lumulus_test_rico PUBLIC ${CMAKE_SOURCE_DIR}/tests)
target_compile_definitions(lumulus_test_rico PRIVATE LUMULUS_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
target_link_libraries(lumulus_test_rico PUBLIC lumulus_vdb PRIVATE lumulus_options)

lumulus_test(vdb_load_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_load_test.cpp LINK lumulus_test_rico OpenVDB::openvdb)
lumulus_test(vdb_choice_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_choice_test.cpp LINK lumulus_vdb OpenVDB::openvdb)
lumulus_test(vdb_values_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_values_test.cpp
                                     ${CMAKE_CURRENT_LIST_DIR}/vdb_place_test.cpp LINK lumulus_vdb OpenVDB::openvdb)
lumulus_test(vdb_reading_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_reading_test.cpp LINK lumulus_vdb OpenVDB::openvdb)
lumulus_test(vdb_nano_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_nano_test.cpp LINK lumulus_vdb OpenVDB::openvdb
                                                                                    Blosc::blosc TBB::tbb ZLIB::ZLIB)
lumulus_test(vdb_refusal_test
             SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_refusal_test.cpp ${CMAKE_CURRENT_LIST_DIR}/vdb_throwing_new.cpp
             LINK lumulus_vdb OpenVDB::openvdb)
lumulus_test(vdb_array_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_array_test.cpp LINK lumulus_vdb)
lumulus_test(vdb_write_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_write_test.cpp LINK lumulus_vdb)
lumulus_test(vdb_quantise_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_quantise_test.cpp LINK lumulus_vdb)
lumulus_test(vdb_procedural_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_procedural_test.cpp LINK lumulus_vdb TBB::tbb)
lumulus_test(vdb_chunks_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_chunks_test.cpp LINK lumulus_vdb OpenVDB::openvdb)
lumulus_test(vdb_sparse_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sparse_volume_test.cpp LINK lumulus_vdb)
lumulus_test(vdb_rim_spectrum_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/vdb_rim_spectrum_test.cpp LINK lumulus_test_rico)
lumulus_test(vdb_sparse_load_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/sparse_load_test.cpp LINK lumulus_vdb OpenVDB::openvdb)
