#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace lumulus::surface {

/// Axes with a normal as the third one.
struct NormalAxes {
    glm::dmat3 columns;

    explicit NormalAxes(const glm::dvec3& normal) {
        const glm::dvec3 aside = std::abs(normal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
        const glm::dvec3 x = glm::normalize(glm::cross(aside, normal));
        columns = glm::dmat3(x, glm::cross(normal, x), normal);
    }
    glm::dvec3 into(const glm::dvec3& v) const { return v * columns; }
    glm::dvec3 outOf(const glm::dvec3& v) const { return columns * v; }
};

}  // namespace lumulus::surface
