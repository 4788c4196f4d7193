#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lumulus::scene {

/// A density field in memory, in the place of a file. Value (i, j, k) sits at `origin` + (i, j, k) · `edges`; outside
/// of all values it is 0. What values may be is the same as in a file.
struct Voxels {
    std::string name;             ///< in messages
    glm::ivec3 size{0};           ///< values along x, y, z
    glm::dvec3 edges{1.0};        ///< of a voxel [m]
    glm::dvec3 origin{0.0};       ///< of value (0, 0, 0) [m]
    std::vector<float> values{};  ///< z fastest
};

}  // namespace lumulus::scene
