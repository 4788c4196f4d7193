#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace lumulus::scene {

/// A section in two brackets that may be repeated, once for each entry.
struct ArraySection {
    std::string_view name;   ///< "fog.media", as in the names of keys
    std::string_view entry;  ///< name of one entry in messages
    std::string_view plural;
    std::size_t most;     ///< entries of a scene
    std::size_t implied;  ///< entries of a scene that says nothing of them
};

inline constexpr std::array<ArraySection, 6> arraySections{{
    {"cloud", "cloud", "clouds", 256, 1},
    {"field", "field", "fields", 64, 0},
    {"fog.media", "medium", "media", 256, 0},
    {"surface", "surface", "surfaces", 256, 0},
    {"lamp", "lamp", "lamps", 4096, 0},
    {"mesh", "mesh", "meshes", 256, 0},
}};

/// The array section that is `path` or that `path` lies in, or null.
inline const ArraySection* arrayOf(std::string_view path) {
    const auto it = std::ranges::find_if(arraySections, [&](const ArraySection& array) {
        return path.starts_with(array.name) && (path.size() == array.name.size() || path[array.name.size()] == '.');
    });
    return it == arraySections.end() ? nullptr : &*it;
}

/// The index in a path of the array section `array`: "12" in "fog.media.12.g".
inline std::string_view indexIn(const ArraySection& array, std::string_view path) {
    const std::string_view rest = path.substr(std::min(path.size(), array.name.size() + 1));
    return rest.substr(0, rest.find('.'));
}

}  // namespace lumulus::scene
