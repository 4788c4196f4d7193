#pragma once

#include "reference/air.h"
#include "reference/air_sky.h"
#include "reference/environment.h"
#include "reference/fog.h"
#include "reference/ground.h"

/// The haze of a scene, by what its light is made of.
namespace lumulus::reference {

inline Fog hazeOf(const scene::Scene& scene, const Environment&) {
    return Fog(scene.fog);
}

inline Air hazeOf(const scene::Scene& scene, const AirSky& sky) {
    const double ground = groundOf(scene)->height;
    const auto coefficient = [&](const glm::dvec3& rgb) { return sky.albedo(rgb); };
    const auto emission = [&](const glm::dvec3& rgb) { return sky.emission(rgb); };
    return {sky.air(), ground, FogMedia<Four>(scene.fog, coefficient, emission, ground), groundOf(scene)->foot};
}

}  // namespace lumulus::reference
