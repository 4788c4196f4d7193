# Not a test: scripts/study/run cycles runs it.
add_executable(export_scene ${CMAKE_CURRENT_LIST_DIR}/export_scene.cpp)
target_include_directories(export_scene PRIVATE ${CMAKE_SOURCE_DIR}/tests)
target_link_libraries(export_scene PRIVATE lumulus_options lumulus_base lumulus_view lumulus_scene lumulus_vdb
                                           lumulus_volume nlohmann_json::nlohmann_json)
