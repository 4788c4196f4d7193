#include "cloud/voxel_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <limits>
#include <numbers>

namespace lumulus::cloud {

namespace {

glm::dvec3 lengthsOf(const glm::dmat3& edges) {
    return {glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2])};
}

}  // namespace

bool hasFlatVoxels(const glm::dmat3& edges) {
    constexpr double flat = 1.1;
    return glm::compMax(lengthsOf(edges)) > flat * shortestEdge(edges);
}

double shortestEdge(const glm::dmat3& edges) {
    return glm::compMin(lengthsOf(edges));
}

double smallestWidth(const glm::dmat3& edges, const glm::dvec3& direction) {
    const glm::dvec3 along = glm::normalize(direction);
    const glm::dvec3 helper = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(along, helper)), up = glm::cross(right, along);
    constexpr int angles = 64;
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < angles; ++i) {
        const double angle = std::numbers::pi * i / angles;
        const glm::dvec3 widths = glm::abs((std::cos(angle) * right + std::sin(angle) * up) * edges);
        smallest = std::min(smallest, glm::compMax(widths));
    }
    return smallest;
}

}  // namespace lumulus::cloud
