#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "shared/mesh.h"

namespace lumulus::bvh {

struct Box {
    glm::vec3 lower{std::numeric_limits<float>::max()};
    glm::vec3 upper{-std::numeric_limits<float>::max()};

    void add(const glm::vec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const Box& box) {
        lower = glm::min(lower, box.lower);
        upper = glm::max(upper, box.upper);
    }
    glm::vec3 middle() const { return 0.5F * lower + 0.5F * upper; }
    /// Half the area of its surface, by which the cost of a box is counted; 0 for an empty one.
    float area() const;
};

/// A tree of boxes. Node 0 is the root; leaves name places in `order`.
struct Tree {
    std::vector<shared::MeshNode> nodes;
    std::vector<std::uint32_t> order;  ///< numbers of boxes, leaf by leaf
};

/// Divides boxes by the surface area heuristic with 16 bins an axis (Wald 2007), on all threads of oneTBB; their number
/// changes no bit. No more than shared::MESH_DEPTH levels. At least one box. Errors: what `check` throws, on any
/// thread.
Tree buildTree(std::span<const Box> boxes, const Check& check);

}  // namespace lumulus::bvh
