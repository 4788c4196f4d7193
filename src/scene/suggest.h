#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumulus::scene {

/// A path for --set, and how many letters it is away from what was written.
struct LikelyPath {
    std::string path;
    std::size_t distance = 0;
};

/// Paths for --set that may be meant by one that does not exist ("extinction", "cloud.0.extintion"), the most likely
/// first: whole paths, an entry of an array by the index that was given or else by 0. At most 6.
std::vector<LikelyPath> pathsLike(std::string_view path);

/// A suggestion for an unknown key ("image.widht"): the nearest key or section by edit distance, or the list of those
/// that exist.
std::string suggestKey(std::string_view name);

/// The number of insertions, deletions, substitutions and swaps of neighbours that make `b` from `a`.
std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace lumulus::scene
