#pragma once

#include <string_view>

namespace lumulus {

/// One line on stderr, `lumulus: …`, that is no complaint; as logWarning's.
void logNote(std::string_view text);

/// One line on stderr, `lumulus: warning: …`. Whatever the text quotes, the line is short and safe for a terminal.
void logWarning(std::string_view text);

/// One line on stderr, `lumulus: error: …`, as logWarning's.
void logError(std::string_view text);

}  // namespace lumulus
