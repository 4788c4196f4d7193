#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumulus::scene {

/// Pairs of keys of which only one may be given: of the same section (in an array, of the same entry), or of two
/// sections that are no arrays.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 31> alternatives{{
    {"sun.direction_to", "sun.azimuth"},
    {"sun.direction_to", "sun.elevation"},
    {"cloud.vdb", "cloud.procedural"},
    {"fog.media.visibility", "fog.media.scattering"},
    {"fog.media.visibility", "fog.media.absorption"},
    {"fog.media.aerosol", "fog.media.scattering"},
    {"fog.media.aerosol", "fog.media.absorption"},
    {"fog.media.aerosol", "fog.media.g"},
    {"fog.media.albedo", "fog.media.aerosol"},
    {"fog.media.albedo", "fog.media.scattering"},
    {"fog.media.albedo", "fog.media.absorption"},
    {"sun.direction_to", "time.utc"},
    {"sun.direction_to", "time.latitude"},
    {"sun.direction_to", "time.longitude"},
    {"sun.azimuth", "time.utc"},
    {"sun.azimuth", "time.latitude"},
    {"sun.azimuth", "time.longitude"},
    {"sun.elevation", "time.utc"},
    {"sun.elevation", "time.latitude"},
    {"sun.elevation", "time.longitude"},
    {"moon.azimuth", "time.utc"},
    {"moon.azimuth", "time.latitude"},
    {"moon.azimuth", "time.longitude"},
    {"moon.elevation", "time.utc"},
    {"moon.elevation", "time.latitude"},
    {"moon.elevation", "time.longitude"},
    {"moon.phase_angle", "time.utc"},
    {"moon.phase_angle", "time.latitude"},
    {"moon.phase_angle", "time.longitude"},
    {"lamp.direction", "lamp.target"},
    {"lamp.power", "lamp.lumens"},
}};

/// The path of `other` that goes with the path of `own`, both names of the schema: in the same entry where they are of
/// the same section.
inline std::string pathBeside(std::string_view path, std::string_view own, std::string_view other) {
    if (own.substr(0, own.rfind('.')) != other.substr(0, other.rfind('.'))) return std::string(other);
    return std::string(path.substr(0, path.rfind('.'))) + std::string(other.substr(other.rfind('.')));
}

/// The paths that exclude `path`, whose key is called `name` in the schema.
inline std::vector<std::string> alternativesOf(std::string_view path, std::string_view name) {
    std::vector<std::string> others;
    for (const auto& [a, b] : alternatives) {
        if (name == a) others.push_back(pathBeside(path, a, b));
        if (name == b) others.push_back(pathBeside(path, b, a));
    }
    return others;
}

}  // namespace lumulus::scene
