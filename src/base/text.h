#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lumulus {

/// Makes one line that a terminal can show from foreign text (a file name, a grid's name, a library's message). Line
/// breaks and tabs become spaces; other control characters and bytes that are no UTF-8 become `\xNN`.
std::string oneLine(std::string_view text);

/// Shortens text of more than about `most` bytes to its beginning and its end, with the number of omitted bytes between
/// them. UTF-8 characters are never divided.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace lumulus
