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
             const std::optional<scene::Ground>& theGround = {}, const std::optional<scene::Ground>& thePlanet = {})
        : sun(theSun), environment(theEnvironment), ground(theGround), planet(thePlanet) {}

    scene::Sun sun;
    sky::Environment environment;
    std::optional<scene::Ground> ground;  ///< absent: nothing is below the clouds, or the environment has it
    std::optional<scene::Ground> planet;  ///< that of an atmosphere

    /// Sun or moon, whichever is brighter at the clouds: photons and shadow volumes are of its light. The other one
    /// shines from a cell of the sky.
    const scene::Sun& direct() const { return moonLeads_ ? *environment.moon() : sun; }
    /// Decides that, for clouds about this point.
    void chooseDirect(const glm::dvec3& point);
    bool hasSun() const { return sun.irradiance.x > 0.0 || sun.irradiance.y > 0.0 || sun.irradiance.z > 0.0; }
    bool isDark() const { return !hasSun() && environment.isDark(sun); }
    /// Radiance of a constant sky [W/(m² sr)]; black under an atmosphere.
    glm::dvec3 constantSky() const { return glm::dvec3(environment.params().radiance); }
    /// direct() as it reaches a point through the fog, if there is any, and the air; from below a ground, not at all.
    scene::Sun sunAt(const glm::dvec3& point, const scene::Fog& fog) const;
    /// Light of sky and ground above a place, at heights [m] from `heights.x` to `heights.y`, where the sky is an
    /// atmosphere. They are made anew where the sun has changed.
    const sky::SkyMaps& skyMaps(const glm::dvec3& place, const glm::dvec2& heights);

  private:
    /// What maps of the sky depend on.
    struct Above {
        glm::dvec3 place;
        scene::Sun sun;
        bool moonLeads;
        glm::ivec2 levels;
        bool operator==(const Above&) const = default;
    };
    std::optional<sky::SkyMaps> skyMaps_;
    std::optional<Above> above_;  ///< of skyMaps_
    bool moonLeads_ = false;
};

}  // namespace lumulus::light
