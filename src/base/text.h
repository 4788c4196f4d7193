#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lumulus {

/// Foreign text (a file name, a grid's name, a library's message) as one line that a terminal can show: line breaks and
/// tabs become spaces, other control characters and bytes that are no UTF-8 become `\xNN`.
std::string oneLine(std::string_view text);

/// The text, or where it is longer than about `most` bytes its beginning and its end, between them how much is left
/// out. Whole UTF-8 characters stay whole.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace lumulus
