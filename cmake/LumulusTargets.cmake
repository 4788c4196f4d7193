# Flags that every target of ours shares, and the shape of a library target: one a folder.

add_library(lumulus_options INTERFACE)
target_compile_options(lumulus_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
target_compile_definitions(lumulus_options INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_ENABLE_EXPERIMENTAL)
if(LUMULUS_SANITIZE)
  # g++ 12 warns falsely in inlined library code under the sanitizers; the release build keeps these warnings as errors
  target_compile_options(lumulus_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                         -fno-omit-frame-pointer -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-array-bounds)
  target_link_options(lumulus_options INTERFACE -fsanitize=address,undefined)
endif()

# lumulus_library(NAME SOURCES… LINK PUBLIC|PRIVATE …)
function(lumulus_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  # The Python module is a shared object; functions of a file may still be inlined within it.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${name} PRIVATE -fno-semantic-interposition)
  target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/shaders)
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE lumulus_options ${ARG_PRIVATE})
endfunction()
