#pragma once

#include <array>
#include <glm/glm.hpp>

namespace lumulus::photon {

/// What a photon map knows of the light in one leaf of a cloud: a mean over its density, of all light but what comes
/// straight from the sun. Exact where the medium has no forward cut.
struct LeafLight {
    glm::dvec3 corner{0.0};                    ///< of its box [m]
    glm::dmat3 edges{1.0};                     ///< of its box, columns [m]
    double voxels = 1.0;                       ///< along its longest edge
    double mass = 0.0;                         ///< ∫ σt dV [m²]
    std::array<glm::dvec3, 9> coefficients{};  ///< Σ c_i y_i(ω), ω the direction of travel, RGB [W m⁻² sr^−½]
};

}  // namespace lumulus::photon
