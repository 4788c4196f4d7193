#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace lumulus::sky {

/// Cells of the sphere of directions, latitude by longitude: columns by azimuth, rows from the zenith down.
struct SkyCells {
    glm::ivec2 size{64, 32};  ///< columns and rows
    glm::dmat3 axes{1.0};     ///< from the cells' frame (first column, up, a quarter on) to the world

    int count() const { return size.x * size.y; }
    /// A direction within a cell, by two numbers in [0,1), uniform over its solid angle.
    glm::dvec3 direction(int cell, const glm::dvec2& u) const {
        const glm::dvec2 sines = sinesOf(cell / size.x);
        const double up = sines.x + (sines.y - sines.x) * u.y, across = std::sqrt(std::max(0.0, 1.0 - up * up));
        const double azimuth = 2.0 * std::numbers::pi * (cell % size.x + u.x) / size.x;
        return axes * glm::dvec3(across * std::cos(azimuth), up, across * std::sin(azimuth));
    }
    double solidAngle(int cell) const {
        const glm::dvec2 sines = sinesOf(cell / size.x);
        return (sines.x - sines.y) * 2.0 * std::numbers::pi / size.x;
    }

  private:
    /// Sines of the elevations between which a row lies.
    glm::dvec2 sinesOf(int row) const {
        return {std::cos(std::numbers::pi * row / size.y), std::cos(std::numbers::pi * (row + 1) / size.y)};
    }
};

}  // namespace lumulus::sky
