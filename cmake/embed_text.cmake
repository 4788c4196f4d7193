# embed_text(OUTPUT NAMESPACE FILES…): a header with the text of each file as `inline constexpr std::string_view`, named
# after the file (index.html: index_html). Made again when a file changes.
function(embed_text output namespace)
  set(text "#pragma once\n\n#include <string_view>\n\nnamespace ${namespace} {\n\n")
  foreach(file ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME)
    string(REPLACE "." "_" symbol ${name})
    file(READ ${file} content)
    string(APPEND text "inline constexpr std::string_view ${symbol} = R\"EMBEDDED(${content})EMBEDDED\";\n\n")
  endforeach()
  string(APPEND text "}  // namespace ${namespace}\n")
  file(CONFIGURE OUTPUT ${output} CONTENT "${text}" @ONLY)
endfunction()
