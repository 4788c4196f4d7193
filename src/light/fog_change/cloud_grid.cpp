#include "light/fog_change/cloud_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumulus::fog_change {

namespace {

constexpr double mostCells = 262144.0;

}  // namespace

glm::dvec2 partInBox(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dvec3& origin,
                     const glm::dvec3& direction) {
    glm::dvec2 part(0.0, std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-12) {
            if (origin[axis] < lower[axis] || origin[axis] > upper[axis]) return glm::dvec2(0.0);
            continue;
        }
        const double a = (lower[axis] - origin[axis]) / direction[axis];
        const double b = (upper[axis] - origin[axis]) / direction[axis];
        part.x = std::max(part.x, std::min(a, b));
        part.y = std::min(part.y, std::max(a, b));
    }
    return part;
}

CloudGrid::CloudGrid(const query::Clouds& clouds, std::optional<double> lowest, const Check& check) {
    const query::Extent extent = clouds.extent().value_or(query::Extent{});
    lower_ = extent.lower;
    upper_ = extent.upper;
    if (lowest) lower_.y = std::max(lower_.y, *lowest);
    upper_.y = std::max(upper_.y, lower_.y);
    const glm::dvec3 size = upper_ - lower_;
    const double volume = size.x * size.y * size.z;
    const double edge = std::max({clouds.finestVoxel(), std::cbrt(volume / mostCells), 1e-3});
    cells_ = glm::max(glm::ivec3(glm::ceil(size / edge)), glm::ivec3(1));
    edge_ = glm::max(size / glm::dvec3(cells_), 1e-9);
    extinction_.resize(indexOf(glm::ivec3(0, 0, cells_.z)));
    tbb::parallel_for(0, cells_.z, [&](int z) {
        check();
        for (int y = 0; y < cells_.y; ++y)
            for (int x = 0; x < cells_.x; ++x) {
                double sum = 0.0;
                for (const double at : {0.25, 0.75}) {  // along one of the two diagonals
                    const double across = (x + y + z) % 2 == 0 ? at : 1.0 - at;
                    const glm::dvec3 from = lower_ + edge_ * glm::dvec3(x + at, y, z + across);
                    sum += 0.5 * clouds.opticalDepth({from, glm::dvec3(0.0, 1.0, 0.0), edge_.y});
                }
                extinction_[indexOf({x, y, z})] = static_cast<float>(sum / edge_.y);
            }
    });
}

CloudGrid::CloudGrid(const glm::dvec3& lower, const glm::dvec3& upper, double extinction)
    : lower_(lower), upper_(upper), edge_(upper - lower), extinction_(1, static_cast<float>(extinction)) {}

std::size_t CloudGrid::indexOf(const glm::ivec3& cell) const {
    return static_cast<std::size_t>(cell.x) +
           static_cast<std::size_t>(cells_.x) * (static_cast<std::size_t>(cell.y) +
                                                 static_cast<std::size_t>(cells_.y) * static_cast<std::size_t>(cell.z));
}

bool CloudGrid::contains(const glm::dvec3& point) const {
    return glm::all(glm::greaterThanEqual(point, lower_)) && glm::all(glm::lessThanEqual(point, upper_));
}

double CloudGrid::extinctionAt(const glm::dvec3& point) const {
    const glm::ivec3 cell(glm::floor((point - lower_) / edge_));
    return static_cast<double>(extinction_[indexOf(glm::clamp(cell, glm::ivec3(0), cells_ - 1))]);
}

std::optional<double> CloudGrid::collision(const glm::dvec3& origin, const glm::dvec3& direction, double length,
                                           double depth) const {
    const glm::dvec2 part = partInBox(lower_, upper_, origin, direction);
    const double end = std::min(part.y, length);
    if (!(part.x < end)) return std::nullopt;
    const glm::dvec3 entry = (origin + part.x * direction - lower_) / edge_;
    glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(entry)), glm::ivec3(0), cells_ - 1);
    glm::dvec3 next, stride;
    glm::ivec3 step;
    for (int axis = 0; axis < 3; ++axis) {
        const double velocity = direction[axis] / edge_[axis];
        step[axis] = velocity > 0.0 ? 1 : -1;
        stride[axis] = std::abs(velocity) > 1e-12 ? 1.0 / std::abs(velocity) : 1e30;
        const double plane = velocity > 0.0 ? cell[axis] + 1.0 : cell[axis];
        next[axis] = std::abs(velocity) > 1e-12 ? part.x + (plane - entry[axis]) / velocity : 1e30;
    }
    for (double at = part.x; at < end;) {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        const double out = std::clamp(next[axis], at, end);
        const auto extinction = static_cast<double>(extinction_[indexOf(cell)]);
        const double passed = extinction * (out - at);
        if (passed >= depth && passed > 0.0) return at + depth / extinction;
        depth -= passed;
        at = out;
        next[axis] += stride[axis];
        cell[axis] += step[axis];
        if (cell[axis] < 0 || cell[axis] >= cells_[axis]) break;
    }
    return std::nullopt;
}

}  // namespace lumulus::fog_change
