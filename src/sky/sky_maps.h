#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "sky/atmosphere.h"

namespace lumulus::sky {

/// Light of sky and ground from all directions at some heights, as photons start from it: latitude by longitude, rows
/// from the zenith down, columns by azimuth, clockwise from that of the sun. Rec. 709 in W/(m² sr).
class SkyMaps {
  public:
    static constexpr int columns = 64, rows = 32, cells = columns * rows;
    static constexpr std::array<double, 5> heights{0.0, 1500.0, 4000.0, 10000.0, 20000.0};  ///< above the ground [m]

    /// Makes the maps above a point of the ground.
    SkyMaps(const Atmosphere& atmosphere, const glm::dvec3& place, const scene::Sun& sun);

    /// Radiance of a cell at a height, linear between those of the maps.
    glm::dvec3 radiance(int cell, double height) const;
    /// A direction within a cell, by two numbers in [0,1), uniform over its solid angle.
    glm::dvec3 direction(int cell, const glm::dvec2& u) const;
    static double solidAngle(int cell);
    /// From the maps' frame to the world: columns are those of direction()'s frame (sun's azimuth, up, beside).
    const glm::dmat3& axes() const { return axes_; }
    /// Whether these are the maps of a place and a sun.
    bool isOf(const glm::dvec3& place, const scene::Sun& sun) const;

  private:
    glm::dmat3 axes_{1.0};
    glm::dvec3 place_, toSun_, irradiance_;
    std::array<std::vector<glm::dvec3>, heights.size()> radiance_;
};

}  // namespace lumulus::sky
