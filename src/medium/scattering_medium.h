#pragma once

#include <glm/glm.hpp>

#include "medium/scattering_tables.h"

namespace lumulus::phase {

/// What a cloud is made of, as photons and drawing need to know it.
struct ScatteringMedium {
    double extinction = 0.0;  ///< σt where the normalised density is 1 [1/m]
    glm::dvec3 albedo{1.0};
    ScatteringTables tables;

    bool scatters() const { return albedo != glm::dvec3(0.0); }
    bool isGrey() const { return albedo == glm::dvec3(albedo.x) && !tables.coloured; }
};

}  // namespace lumulus::phase
