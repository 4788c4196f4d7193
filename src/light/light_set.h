#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "sky/environment.h"

namespace lumulus::light {

/// The lights of the world: sun and environment, as they are before fog and clouds.
struct LightSet {
    scene::Sun sun;
    sky::Environment environment;

    bool hasSun() const { return sun.irradiance.x > 0.0 || sun.irradiance.y > 0.0 || sun.irradiance.z > 0.0; }
    bool isDark() const { return !hasSun() && environment.isDark(sun); }
    /// The sun as it reaches a point through the fog, if there is any, and the air.
    scene::Sun sunAt(const glm::dvec3& point, const scene::Fog& fog) const;
};

}  // namespace lumulus::light
