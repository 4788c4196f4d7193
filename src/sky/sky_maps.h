#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "sky/atmosphere.h"
#include "sky/sky_cells.h"

namespace lumulus::sky {

/// Light of sky and ground from all directions at some heights, as photons start from it: latitude by longitude, rows
/// from the zenith down, columns by azimuth, clockwise from that of the sun. Rec. 709 in W/(m² sr).
class SkyMaps {
  public:
    static constexpr int columns = 64, rows = 32, cells = columns * rows;
    static constexpr std::array<double, 5> heights{0.0, 1500.0, 4000.0, 10000.0, 20000.0};  ///< above the ground [m]

    /// Makes the maps above a point of the ground, with the light that a sun or moon has sent into the air. `levels`:
    /// the first of the heights that are needed, and the last.
    SkyMaps(const Atmosphere& atmosphere, const glm::dvec3& place, const scene::Sun& sun,
            const glm::ivec2& levels = {0, heights.size() - 1});

    /// Adds that of another one, which shines itself from the cell in which it stands.
    void add(const Atmosphere& atmosphere, const scene::Sun& other);
    /// The levels between which heights from `low` to `high` lie.
    static glm::ivec2 levelsOf(double low, double high);

    /// Radiance of a cell at a height, linear between those of the maps.
    glm::dvec3 radiance(int cell, double height) const;
    /// Their cells, in the frame of the sun's azimuth.
    const SkyCells& frame() const { return frame_; }

  private:
    void addSky(const Atmosphere& atmosphere, const scene::Sun& sun, int asked);

    SkyCells frame_{{columns, rows}};
    glm::ivec2 levels_;
    std::array<std::vector<glm::dvec3>, heights.size()> radiance_;
};

}  // namespace lumulus::sky
