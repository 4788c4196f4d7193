#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumulus::scene {

/// Pairs of keys of the same section of which only one may be given.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 5> alternatives{{
    {"sun.direction_to", "sun.azimuth"},
    {"sun.direction_to", "sun.elevation"},
    {"cloud.vdb", "cloud.procedural"},
    {"fog.media.visibility", "fog.media.scattering"},
    {"fog.media.visibility", "fog.media.absorption"},
}};

/// The path of another key of the same section (and, in an array, the same entry): `name` is a name of the schema.
inline std::string siblingPath(std::string_view path, std::string_view name) {
    return std::string(path.substr(0, path.rfind('.'))) + std::string(name.substr(name.rfind('.')));
}

/// The paths that exclude `path`, whose key is called `name` in the schema.
inline std::vector<std::string> alternativesOf(std::string_view path, std::string_view name) {
    std::vector<std::string> others;
    for (const auto& [a, b] : alternatives) {
        if (name == a) others.push_back(siblingPath(path, b));
        if (name == b) others.push_back(siblingPath(path, a));
    }
    return others;
}

}  // namespace lumulus::scene
