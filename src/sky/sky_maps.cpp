#include "sky/sky_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/row_light.h"
#include "sky/shell.h"

namespace lumulus::sky {

namespace {

constexpr int steps = 24;

/// The level above a height, and not the lowest.
int levelAbove(double height) {
    int above = 1;
    while (above + 1 < static_cast<int>(SkyMaps::heights.size()) &&
           SkyMaps::heights[static_cast<std::size_t>(above)] < height)
        ++above;
    return above;
}

}  // namespace

SkyMaps::SkyMaps(const Atmosphere& atmosphere, const glm::dvec3& place, const scene::Sun& sun, const glm::ivec2& levels)
    : levels_(levels) {
    const glm::dvec3 up = atmosphere.upAt(place);
    glm::dvec3 across = sun.directionTo - glm::dot(up, sun.directionTo) * up;
    if (glm::length(across) < 1e-9)
        across = glm::cross(up, std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
    across = glm::normalize(across);
    frame_.axes = glm::dmat3(across, up, glm::cross(across, up));
    for (int level = levels_.x; level <= levels_.y; ++level)
        radiance_[static_cast<std::size_t>(level)].assign(cells, glm::dvec3(0.0));
    addSky(atmosphere, sun, columns / 2);
}

void SkyMaps::add(const Atmosphere& atmosphere, const scene::Sun& other) {
    addSky(atmosphere, other, columns);
    // its own light comes from the cell in which it stands
    const glm::dvec3 local = glm::transpose(frame_.axes) * other.directionTo;
    const double turn = std::atan2(local.z, local.x) / (2.0 * std::numbers::pi);
    const int column = std::min(columns - 1, static_cast<int>((turn - std::floor(turn)) * columns));
    const double down = std::acos(std::clamp(local.y, -1.0, 1.0)) / std::numbers::pi;
    const int cell = std::min(rows - 1, static_cast<int>(down * rows)) * columns + column;
    for (int level = levels_.x; level <= levels_.y; ++level) {
        const AirPoint here{heights[static_cast<std::size_t>(level)], local.y, local.y, 1.0};
        const glm::dvec3 light = atmosphere.air().rgb(atmosphere.sunTransmittance(here.height, here.sun));
        radiance_[static_cast<std::size_t>(level)][static_cast<std::size_t>(cell)] +=
            glm::max(light, glm::dvec3(0.0)) * (other.irradiance / atmosphere.sunAbove()) / frame_.solidAngle(cell);
    }
}

/// The light that a sun has sent into the air. Where only half of the columns are asked for, the sky is the same to
/// both sides of the sun.
void SkyMaps::addSky(const Atmosphere& atmosphere, const scene::Sun& sun, int asked) {
    const glm::dvec3& up = frame_.axes[1];
    const double sunUp = std::clamp(glm::dot(up, sun.directionTo), -1.0, 1.0);
    const glm::dvec3 scale = sun.irradiance / atmosphere.sunAbove();
    tbb::parallel_for(levels_.x * rows, (levels_.y + 1) * rows, [&](int index) {
        const auto level = static_cast<std::size_t>(index / rows);
        const int row = index % rows;
        const double cosine = glm::dot(frame_.direction(row * columns, {0.5, 0.5}), up);
        const RowLight rays(atmosphere, heights[level], cosine, sunUp, steps);
        const bool ground = std::isfinite(distanceToGround(heights[level], cosine));
        const glm::dvec3 night = atmosphere.night(ground, rays.transmittance());
        for (int column = 0; column < asked; ++column) {
            const double toSun = glm::dot(frame_.direction(row * columns + column, {0.5, 0.5}), sun.directionTo);
            const glm::dvec3 light = atmosphere.air().rgb(rays.sky(toSun).light(atmosphere.air(), toSun));
            const glm::dvec3 seen = (glm::max(light, glm::dvec3(0.0)) + night) * scale;
            radiance_[level][static_cast<std::size_t>(row * columns + column)] += seen;
            if (asked < columns)
                radiance_[level][static_cast<std::size_t>(row * columns + columns - 1 - column)] += seen;
        }
    });
}

glm::ivec2 SkyMaps::levelsOf(double low, double high) {
    return {levelAbove(low) - 1, levelAbove(high)};
}

glm::dvec3 SkyMaps::radiance(int cell, double height) const {
    const auto above = static_cast<std::size_t>(std::clamp(levelAbove(height), levels_.x + 1, levels_.y));
    const double share = std::clamp((height - heights[above - 1]) / (heights[above] - heights[above - 1]), 0.0, 1.0);
    const auto at = static_cast<std::size_t>(cell);
    return (1.0 - share) * radiance_[above - 1][at] + share * radiance_[above][at];
}

}  // namespace lumulus::sky
