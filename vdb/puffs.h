#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

/// The skeleton of a cumulus: spheres on spheres, as a cauliflower grows.
namespace lumulus::vdb {

struct Puff {
    glm::vec3 centre{0.0F};  ///< metres
    float radius = 0.0F;     ///< metres
};

struct PuffBounds {
    glm::vec3 low{1e9F};
    glm::vec3 high{-1e9F};
};

/// The box around all puffs [m].
PuffBounds boundPuffs(const std::vector<Puff>& puffs);

/// Towers of merged spheres over an oval ground plan, with two generations of ever smaller spheres on their surfaces.
/// The union stands on y = 0 (spheres reach below it: the base is cut there), is `width` metres wide along its longest
/// horizontal side, and is centred above the origin.
std::vector<Puff> growPuffs(std::uint64_t seed, float width);

}  // namespace lumulus::vdb
