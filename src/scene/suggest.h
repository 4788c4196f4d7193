#pragma once

#include <string>
#include <string_view>

namespace lumulus::scene {

/// How to mend an unknown key ("image.widht"): the nearest key or section by edit distance, else what there is to
/// choose from.
std::string suggestKey(std::string_view name);

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`.
std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace lumulus::scene
