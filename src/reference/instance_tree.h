#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "view/camera.h"

namespace lumulus::reference {

/// A box along the axes of the world, metres.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void include(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void include(const Box& other) {
        include(other.low);
        include(other.high);
    }
};

/// A binary tree over boxes (split at the median of the longest side), to find those that a ray may meet.
class InstanceTree {
  public:
    explicit InstanceTree(std::span<const Box> boxes);

    /// Calls `visit(index)` for the boxes that the ray meets before `limit` metres, roughly nearest first. `visit`
    /// returns the limit from there on.
    template <typename Visit>
    void visit(const Ray& ray, double limit, Visit&& visit) const;

  private:
    /// An inner node has its children at `first` and `first + 1`; a leaf has `count` entries of `order_` from `first`.
    struct Node {
        Box box;
        std::uint32_t first = 0;
        std::uint32_t count = 0;  ///< 0: inner
    };

    /// The ray in the form that boxes are tested with.
    struct Slopes {
        glm::dvec3 origin, inverse;
        /// Metres to the box, 0 within it, infinity where the ray misses it.
        double metresTo(const Box& box) const;
    };

    void split(std::size_t node, std::span<std::uint32_t> entries, std::span<const Box> boxes);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

inline double InstanceTree::Slopes::metresTo(const Box& box) const {
    const glm::dvec3 a = (box.low - origin) * inverse, b = (box.high - origin) * inverse;
    const glm::dvec3 near = glm::min(a, b), far = glm::max(a, b);
    const double begin = std::max({0.0, near.x, near.y, near.z}), end = std::min({far.x, far.y, far.z});
    return begin <= end ? begin : std::numeric_limits<double>::infinity();
}

template <typename Visit>
void InstanceTree::visit(const Ray& ray, double limit, Visit&& visit) const {
    Slopes slopes{ray.origin, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const double step = ray.direction[axis];
        slopes.inverse[axis] = 1.0 / (std::abs(step) > 1e-300 ? step : 1e-300);
    }
    struct Waiting {
        double metres;
        std::uint32_t node;
    };
    std::array<Waiting, 64> stack;  // a median split: 64 levels are never reached
    std::size_t waiting = 0;
    const auto push = [&](double metres, std::uint32_t node) {
        if (metres < limit) stack[waiting++] = {metres, node};
    };
    push(slopes.metresTo(nodes_[0].box), 0);
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (!(next.metres < limit)) continue;
        const Node& node = nodes_[next.node];
        for (std::uint32_t i = 0; i < node.count; ++i) limit = visit(order_[node.first + i]);
        if (node.count > 0) continue;
        const double left = slopes.metresTo(nodes_[node.first].box),
                     right = slopes.metresTo(nodes_[node.first + 1].box);
        push(std::max(left, right), left > right ? node.first : node.first + 1);
        push(std::min(left, right), left > right ? node.first + 1 : node.first);
    }
}

}  // namespace lumulus::reference
