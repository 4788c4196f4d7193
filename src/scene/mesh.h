#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>

/// Triangle meshes that stand in the picture (docs/meshes.md).
namespace lumulus::scene {

struct Mesh {
    std::string name;                 ///< empty: its index
    std::filesystem::path gltf;       ///< .glb or .gltf
    glm::dvec3 position{0.0};         ///< of the file's origin, metres
    double yaw = 0.0;                 ///< degrees, clockwise seen from above
    double scale = 1.0;               ///< factor of all lengths
    std::filesystem::path instances;  ///< CSV of places; empty: one instance

    bool operator==(const Mesh&) const = default;
};

}  // namespace lumulus::scene
