#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/bvh/tree.h"
#include "mesh/placed.h"

namespace lumulus::bvh {

/// Trees of all meshes of a scene as rays go through them: that of the instances first, then that of each model.
struct World {
    glm::dvec3 middle{0.0};  ///< that positions are relative to, metres
    std::vector<shared::MeshNode> nodes;
    std::vector<shared::MeshTriangle> triangles;  ///< in the order of leaves
    std::vector<std::uint32_t> triangleNumbers;   ///< of each: its number in its model
    std::vector<std::size_t> firstTriangles;      ///< of each model, among those of all
    std::vector<shared::MeshInstance> instances;  ///< in the order of leaves
    Box box;                                      ///< of all, relative to the middle

    /// Largest distance of a point of a mesh from the middle, metres.
    float reach() const { return glm::length(glm::max(glm::abs(box.lower), glm::abs(box.upper))); }
};

/// `placed`: one instance at least. Errors: what `check` throws.
World buildWorld(const mesh::Placed& placed, const Check& check);

/// What a ray meets first, on the host; the same arithmetic as on the GPU.
shared::MeshHit nearest(const World& world, const shared::MeshRay& ray);

}  // namespace lumulus::bvh
