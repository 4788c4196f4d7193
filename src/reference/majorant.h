#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/medium.h"
#include "reference/random.h"

namespace lumulus::reference {

enum class Majorant { global, local };

/// Bounds of σt over cubic cells of the voxel grid; one cell for the whole medium where the majorant is global.
class MajorantGrid {
  public:
    MajorantGrid(const Medium& medium, Majorant kind);

    /// Walks the part `inside` of the ray from tentative collision to tentative collision (Woodcock 1965; cells as
    /// Amanatides and Woo 1987), and calls `event(metres, majorant [1/m])` at each; `event` returns true to stop there.
    template <typename Event>
    void walk(const VoxelRay& ray, const Interval& inside, Random& random, Event&& event) const;

  private:
    struct Bound {
        double majorant = 0.0;  ///< 1/m
        double meanStep = 0.0;  ///< its inverse, metres
    };

    double edge_;  ///< of a cell, voxels
    double inverseEdge_;
    glm::ivec3 cells_;
    std::vector<Bound> bounds_;
};

template <typename Event>
void MajorantGrid::walk(const VoxelRay& ray, const Interval& inside, Random& random, Event&& event) const {
    const glm::dvec3 start = ray.at(inside.begin);
    int cell[3], direction[3];
    double next[3], stride[3];
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = std::clamp(static_cast<int>(start[axis] * inverseEdge_), 0, cells_[axis] - 1);
        if (ray.step[axis] == 0.0) {
            direction[axis] = 0;
            next[axis] = stride[axis] = std::numeric_limits<double>::infinity();
            continue;
        }
        direction[axis] = ray.step[axis] > 0.0 ? 1 : -1;
        const double inverse = 1.0 / ray.step[axis];
        stride[axis] = edge_ * std::abs(inverse);
        next[axis] = ((cell[axis] + (direction[axis] > 0 ? 1 : 0)) * edge_ - ray.origin[axis]) * inverse;
    }
    const int strides[3] = {direction[0], direction[1] * cells_.x, direction[2] * cells_.x * cells_.y};
    const Bound* bound = bounds_.data() + (cell[2] * cells_.y + cell[1]) * cells_.x + cell[0];
    double t = inside.begin;
    double depth = random.exponential();
    for (;;) {
        const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        const double end = std::max(t, std::min(next[axis], inside.end));
        if (bound->majorant > 0.0) {
            for (;;) {
                const double collision = t + depth * bound->meanStep;
                if (!(collision < end)) break;
                t = collision;
                if (event(t, bound->majorant)) return;
                depth = random.exponential();
            }
            depth = std::max(0.0, depth - (end - t) * bound->majorant);
        }
        t = end;
        next[axis] += stride[axis];
        cell[axis] += direction[axis];
        if (t >= inside.end || cell[axis] < 0 || cell[axis] >= cells_[axis]) return;
        bound += strides[axis];
    }
}

}  // namespace lumulus::reference
