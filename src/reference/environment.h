#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "reference/random.h"
#include "reference/sky_map.h"
#include "reference/sun_disc.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// What lies behind everything else in a scene without air: the sky, of one colour or a map, and the sun before it.
/// Nothing else in the reference knows what that sky is like.
class Environment {
  public:
    /// Errors: those of SkyMap.
    explicit Environment(const scene::Scene& scene);

    /// Radiance of the sky without the sun in a direction from anywhere, W·m⁻²·sr⁻¹.
    glm::dvec3 radiance(const glm::dvec3& direction) const { return unit_ * relativeRadiance(direction); }

    /// The same, divided by `unit`. A sky of one colour is 1 everywhere, so that sums over samples of it are exact.
    glm::dvec3 relativeRadiance(const glm::dvec3& direction) const {
        return map_ ? map_->radiance(direction) : glm::dvec3(1.0);
    }

    /// What `relativeRadiance` counts in, W·m⁻²·sr⁻¹.
    const glm::dvec3& unit() const { return unit_; }

    /// Whether the sky has bright places to aim at.
    bool aimed() const { return map_.has_value(); }
    /// A direction drawn by brightness, and the density of such draws in a direction, where the sky is aimed at.
    SkyMapSample sample(Random& random) const { return map_->sample(random); }
    double density(const glm::dvec3& direction) const { return map_->density(direction); }

    const SunDisc& sun() const { return sun_; }

    /// Whether there is light of the sun.
    bool sunny() const { return sunny_; }

    /// What the disc of the sun adds to a ray; 0 beside it. W·m⁻²·sr⁻¹.
    glm::dvec3 discRadiance(const glm::dvec3& direction) const {
        return meanDiscRadiance_ * sun_.relativeRadiance(direction);
    }

    /// The mean over the disc; 0 for a sun that is a point.
    const glm::dvec3& meanDiscRadiance() const { return meanDiscRadiance_; }

    /// ∫ L dω over the disc, W·m⁻².
    const glm::dvec3& sunFluence() const { return sunFluence_; }

    /// Light as colour, and colours of the scene as light: here they are one.
    const glm::dvec3& rgb(const glm::dvec3& light) const { return light; }
    const glm::dvec3& albedo(const glm::dvec3& rgb) const { return rgb; }
    const glm::dvec3& emission(const glm::dvec3& rgb) const { return rgb; }

  private:
    Environment(const scene::Scene& scene, std::optional<SkyMap> map);
    Environment(const scene::Sky& sky, std::optional<SkyMap> map, const scene::Sun& sun);

    std::optional<SkyMap> map_;
    glm::dvec3 unit_;
    SunDisc sun_;
    glm::dvec3 sunFluence_;
    glm::dvec3 meanDiscRadiance_;
    bool sunny_;
};

}  // namespace lumulus::reference
