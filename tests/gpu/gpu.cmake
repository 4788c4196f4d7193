lumulus_shaders(
  lumulus_gpu_test_shaders
  gpu/shaders/copy.comp
  gpu/shaders/fetch_integers.comp
  gpu/shaders/halve_layers.comp
  gpu/shaders/layout.comp
  gpu/shaders/sample_level.comp
  gpu/shaders/sample_volume.comp
  gpu/shaders/scale.comp
  gpu/shaders/store_formats.comp
  gpu/shaders/store_half.comp
  gpu/shaders/sum.comp
  gpu/shaders/unsupported.comp)

lumulus_test(
  gpu_test
  SOURCES
    ${CMAKE_CURRENT_LIST_DIR}/allocator_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/commands_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/device_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/hazards_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/image_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/memory_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/program_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/support/vulkan_main.cpp
  LINK lumulus_gpu fmt::fmt lumulus_gpu_test_shaders ${CMAKE_DL_LIBS})
