#pragma once

#include <string_view>

namespace lumulus {

/// Writes a message that is no complaint as one line on stderr, `lumulus: …`, shortened as by logWarning.
void logNote(std::string_view text);

/// Writes one line on stderr, `lumulus: warning: …`, shortened and made safe for a terminal.
void logWarning(std::string_view text);

/// Writes one line on stderr, `lumulus: error: …`, shortened as by logWarning.
void logError(std::string_view text);

}  // namespace lumulus
