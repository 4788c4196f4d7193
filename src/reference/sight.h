#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "reference/clouds.h"
#include "reference/solids.h"

namespace lumulus::reference {

/// Integrals along a ray, without noise.
struct RayIntegrals {
    glm::dvec3 transmittance{1.0};  ///< of everything: clouds, fog and solids
    double clear = 1.0;             ///< transmittance of clouds and solids alone
    double distance = 0.0;          ///< to clouds and solids: over 1 − clear, their mean distance. Metres
};

/// The air of an atmosphere is part of the sky and does not count here.
template <typename Haze>
RayIntegrals integrateRay(const Clouds& clouds, const Solids& solids, const Haze& haze, const Ray& ray) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    RayIntegrals result;
    const std::optional<double> hit = solids.thing(ray);
    const LineIntegrals line = clouds.integrate(ray, hit.value_or(endless));
    result.clear = line.transmittance;
    result.distance = line.distance;
    if (hit) {
        result.distance += result.clear * *hit;
        result.clear = 0.0;
    }
    result.transmittance = glm::dvec3(result.clear);
    if (haze.hasFog()) result.transmittance *= haze.fogTransmittance(ray, endless);
    return result;
}

/// Metres to the nearest point of cloud or solid on the ray; absent if there is none.
inline std::optional<double> frontOf(const Clouds& clouds, const Solids& solids, const Ray& ray) {
    const std::optional<double> metres = clouds.front(ray), hit = solids.thing(ray);
    return hit && !(metres && *metres < *hit) ? hit : metres;
}

}  // namespace lumulus::reference
