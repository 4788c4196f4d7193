# lumulus_shaders(TARGET stage/name.comp…): compiles GLSL to SPIR-V at build time, each into a C++ header
# `spirv/stage/name.comp.h` that defines `name_comp[]` (uint32_t words), for inclusion inside a namespace.
function(lumulus_shaders target)
  set(headers "")
  foreach(source ${ARGN})
    get_filename_component(folder ${source} DIRECTORY)
    get_filename_component(file ${source} NAME)
    string(REPLACE "." "_" symbol ${file})
    set(header ${CMAKE_BINARY_DIR}/spirv/${source}.h)
    file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/spirv/${folder})
    add_custom_command(
      OUTPUT ${header}
      COMMAND Vulkan::glslangValidator --quiet --target-env vulkan1.3 -I${CMAKE_SOURCE_DIR}/shaders
              --depfile ${header}.d --vn ${symbol} -o ${header} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      DEPFILE ${header}.d
      COMMENT "SPIR-V ${source}"
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${target}_spirv DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_spirv)
  target_include_directories(${target} INTERFACE ${CMAKE_BINARY_DIR})
endfunction()
