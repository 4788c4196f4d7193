#include "sky/sky_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::sky {

using std::numbers::pi;

namespace {

constexpr int steps = 24;

/// Sines of the elevations between which a row lies.
glm::dvec2 sinesOf(int row) {
    return {std::cos(pi * row / SkyMaps::rows), std::cos(pi * (row + 1) / SkyMaps::rows)};
}

}  // namespace

SkyMaps::SkyMaps(const Atmosphere& atmosphere, const glm::dvec3& place, const scene::Sun& sun)
    : place_(place), toSun_(sun.directionTo), irradiance_(sun.irradiance) {
    const glm::dvec3 up = atmosphere.upAt(place);
    const double sunUp = std::clamp(glm::dot(up, sun.directionTo), -1.0, 1.0);
    glm::dvec3 across = sun.directionTo - sunUp * up;
    if (glm::length(across) < 1e-9)
        across = glm::cross(up, std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
    across = glm::normalize(across);
    axes_ = glm::dmat3(across, up, glm::cross(across, up));
    const glm::dvec3 scale = sun.irradiance / atmosphere.sunAbove();
    for (auto& map : radiance_) map.resize(cells);
    tbb::parallel_for(0, static_cast<int>(heights.size()) * rows, [&](int index) {
        const auto level = static_cast<std::size_t>(index / rows);
        const int row = index % rows;
        for (int column = 0; column < columns / 2; ++column) {
            const glm::dvec3 towards = direction(row * columns + column, {0.5, 0.5});
            const AirPoint from{heights[level], glm::dot(towards, up), sunUp, glm::dot(towards, sun.directionTo)};
            const glm::dvec3 light =
                atmosphere.air().rgb(atmosphere.sky(from, steps).light(atmosphere.air(), from.toSun));
            const glm::dvec3 seen = glm::max(light, glm::dvec3(0.0)) * scale;
            // the sky is the same to both sides of the sun
            radiance_[level][static_cast<std::size_t>(row * columns + column)] = seen;
            radiance_[level][static_cast<std::size_t>(row * columns + columns - 1 - column)] = seen;
        }
    });
}

bool SkyMaps::isOf(const glm::dvec3& place, const scene::Sun& sun) const {
    return place == place_ && sun.directionTo == toSun_ && sun.irradiance == irradiance_;
}

glm::dvec3 SkyMaps::radiance(int cell, double height) const {
    std::size_t above = 1;
    while (above + 1 < heights.size() && heights[above] < height) ++above;
    const double share = std::clamp((height - heights[above - 1]) / (heights[above] - heights[above - 1]), 0.0, 1.0);
    const auto at = static_cast<std::size_t>(cell);
    return (1.0 - share) * radiance_[above - 1][at] + share * radiance_[above][at];
}

glm::dvec3 SkyMaps::direction(int cell, const glm::dvec2& u) const {
    const glm::dvec2 sines = sinesOf(cell / columns);
    const double up = sines.x + (sines.y - sines.x) * u.y, across = std::sqrt(std::max(0.0, 1.0 - up * up));
    const double azimuth = 2.0 * pi * (cell % columns + u.x) / columns;
    return axes_ * glm::dvec3(across * std::cos(azimuth), up, across * std::sin(azimuth));
}

double SkyMaps::solidAngle(int cell) {
    const glm::dvec2 sines = sinesOf(cell / columns);
    return (sines.x - sines.y) * 2.0 * pi / columns;
}

}  // namespace lumulus::sky
