#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace lumulus::sky {

/// A sun or moon as it is seen from a point.
struct Luminary {
    double elevation = 0.0;        ///< degrees above the horizon, without refraction
    double azimuth = 0.0;          ///< degrees, 0 to 360, clockwise from north (−Z)
    glm::dvec3 irradiance{0.0};    ///< on a plane that faces it, W/m² per channel
    double illuminance = 0.0;      ///< on that plane, lx
    glm::dvec2 chromaticity{0.0};  ///< x and y of CIE 1931; 0 where it is dark
};

/// Light of a scene's sky at a point, without its clouds.
struct SkyReport {
    Luminary sun, moon;
    double refraction = 0.0;        ///< degrees by which air would lift the sun
    double moonPhaseAngle = 0.0;    ///< degrees, 0 is full
    double skyIlluminance = 0.0;    ///< on a level plane, without sun and moon themselves, lx
    double zenithLuminance = 0.0;   ///< cd/m²
    double horizonLuminance = 0.0;  ///< at an elevation of 2°, away from the sun, cd/m²
};

/// Where somebody looks at the sky of a scene: where its camera stands, or else 2 m above the ground at the origin.
glm::dvec3 observerOf(const scene::Scene& scene);

/// Sums up the light at a point. The moon's light is that of the sun times `scene::moonShare`; it counts for the sky
/// where the scene says that it shines. An atmosphere has `nightLuminance` besides.
SkyReport reportSky(const scene::Scene& scene, const glm::dvec3& point);

}  // namespace lumulus::sky
