#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/scene.h"
#include "sky/environment.h"
#include "sky/sky_maps.h"

namespace lumulus::light {

/// The lights of the world: sun, environment and ground, as they are before fog and clouds.
class LightSet {
  public:
    LightSet(const scene::Sun& theSun, const sky::Environment& theEnvironment,
             const std::optional<scene::Ground>& theGround = {})
        : sun(theSun), environment(theEnvironment), ground(theGround) {}

    scene::Sun sun;
    sky::Environment environment;
    std::optional<scene::Ground> ground;  ///< absent: nothing is below the clouds, or the environment has it

    bool hasSun() const { return sun.irradiance.x > 0.0 || sun.irradiance.y > 0.0 || sun.irradiance.z > 0.0; }
    bool isDark() const { return !hasSun() && environment.isDark(sun); }
    /// Radiance of a constant sky [W/(m² sr)]; black under an atmosphere.
    glm::dvec3 constantSky() const { return glm::dvec3(environment.params().radiance); }
    /// The sun as it reaches a point through the fog, if there is any, and the air; from below a ground, not at all.
    scene::Sun sunAt(const glm::dvec3& point, const scene::Fog& fog) const;
    /// Light of sky and ground above a place, where the sky is an atmosphere. They are made anew where the sun has
    /// changed.
    const sky::SkyMaps& skyMaps(const glm::dvec3& place);

  private:
    std::optional<sky::SkyMaps> skyMaps_;
};

}  // namespace lumulus::light
