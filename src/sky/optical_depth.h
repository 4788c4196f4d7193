#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sky/air.h"

namespace lumulus::sky {

/// Columns of molecules, aerosol and ozone between a point of the air and its top [m of their densities]. They are the
/// same for every medium, and interpolate well where transmittances do not (within a degree of the horizon).
class ColumnTable {
  public:
    ColumnTable();

    /// Columns along a ray that does not meet the ground; for one that does, those of the ray along the horizon.
    glm::dvec3 toTop(double height, double up) const;

    /// Integrated without the table: what tests compare it with.
    static glm::dvec3 integrate(double height, double up);

  private:
    static constexpr int across = 256, down = 64;  // angle by height (Bruneton 2008)
    std::vector<glm::dvec3> columns_;
};

/// Optical depth of columns.
inline Spectrum opticalDepth(const Air& air, const glm::dvec3& columns) {
    return columns.x * air.molecules + columns.y * air.aerosolExtinction + columns.z * air.ozone;
}

}  // namespace lumulus::sky
