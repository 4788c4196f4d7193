#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/scene.h"
#include "sky/environment.h"
#include "sky/sky_maps.h"

namespace lumulus::light {

/// The lights of the world: sun and environment, as they are before fog and clouds.
class LightSet {
  public:
    LightSet(const scene::Sun& theSun, const sky::Environment& theEnvironment)
        : sun(theSun), environment(theEnvironment) {}

    scene::Sun sun;
    sky::Environment environment;

    bool hasSun() const { return sun.irradiance.x > 0.0 || sun.irradiance.y > 0.0 || sun.irradiance.z > 0.0; }
    bool isDark() const { return !hasSun() && environment.isDark(sun); }
    /// The sun as it reaches a point through the fog, if there is any, and the air.
    scene::Sun sunAt(const glm::dvec3& point, const scene::Fog& fog) const;
    /// Light of sky and ground above a place, where the sky is an atmosphere. They are made anew where the sun has
    /// changed.
    const sky::SkyMaps& skyMaps(const glm::dvec3& place);

  private:
    std::optional<sky::SkyMaps> skyMaps_;
};

}  // namespace lumulus::light
