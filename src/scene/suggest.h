#pragma once

#include <string>
#include <string_view>

namespace lumulus::scene {

/// A suggestion for an unknown key ("image.widht"): the nearest key or section by edit distance, or the list of those
/// that exist.
std::string suggestKey(std::string_view name);

/// The number of insertions, deletions, substitutions and swaps of neighbours that make `b` from `a`.
std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace lumulus::scene
