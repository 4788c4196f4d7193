#pragma once

#include <string>
#include <string_view>

namespace lumulus {

/// The text as one line: control characters (a newline in a file name or a library's message) become spaces.
std::string oneLine(std::string_view text);

/// One line on stderr, `lumulus: warning: …`.
void logWarning(std::string_view text);

/// One line on stderr, `lumulus: error: …`.
void logError(std::string_view text);

}  // namespace lumulus
