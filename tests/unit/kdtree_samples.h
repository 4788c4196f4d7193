#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "cloud/kdtree.h"

namespace lumulus::cloud {

/// Samples all over the box; density in 0…1 without any pattern.
inline std::vector<Sample> randomSamples(std::size_t count, const glm::ivec3& size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 u(uniform(random), uniform(random), uniform(random));
        samples.push_back({u * glm::vec3(size), uniform(random)});
    }
    return samples;
}

inline bool contains(const shared::LeafBox& box, const glm::vec3& point) {
    return glm::all(glm::greaterThanEqual(point, glm::vec3(box.lower))) &&
           glm::all(glm::lessThan(point, glm::vec3(box.upper)));
}

/// Edges of a box in voxels.
inline glm::ivec3 extentOf(const shared::LeafBox& box) {
    return box.upper - box.lower;
}

/// Box of every node, from the planes above it.
inline std::vector<shared::LeafBox> nodeBoxes(const KdTree& tree, const glm::ivec3& size) {
    std::vector<shared::LeafBox> boxes(tree.nodes.size());
    boxes[0] = {glm::ivec3(0), size};
    // children come after their parent
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const KdNode& node = tree.nodes[i];
        if (node.axis < 0) continue;
        for (int side = 0; side < 2; ++side) {
            shared::LeafBox box = boxes[i];
            (side == 0 ? box.upper : box.lower)[node.axis] = node.plane;
            boxes[static_cast<std::size_t>(node.child[side])] = box;
        }
    }
    return boxes;
}

}  // namespace lumulus::cloud
