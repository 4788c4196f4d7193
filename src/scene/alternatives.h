#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumulus::scene {

/// Paths of keys of which only one may be given.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 3> alternatives{{
    {"sun.direction_to", "sun.azimuth"},
    {"sun.direction_to", "sun.elevation"},
    {"cloud.0.vdb", "cloud.0.procedural"},
}};

/// The paths that exclude `path`.
inline std::vector<std::string> alternativesOf(std::string_view path) {
    std::vector<std::string> others;
    for (const auto& [a, b] : alternatives) {
        if (path == a) others.emplace_back(b);
        if (path == b) others.emplace_back(a);
    }
    return others;
}

}  // namespace lumulus::scene
