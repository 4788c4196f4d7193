#pragma once

#include <glm/glm.hpp>

#include "reference/random.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// What lies behind everything else in a scene: the sky, here of one colour, and the sun before it. Nothing else in the
/// reference knows what the sky is like.
class Environment {
  public:
    Environment(const scene::Sky& sky, const scene::Sun& sun);

    /// Radiance of the sky without the sun in a direction from anywhere, W·m⁻²·sr⁻¹.
    glm::dvec3 radiance(const glm::dvec3& direction) const { return unit_ * relativeRadiance(direction); }

    /// The same, divided by `unit`. A sky of one colour is 1 everywhere, so that sums over samples of it are exact.
    glm::dvec3 relativeRadiance(const glm::dvec3& /*direction*/) const { return glm::dvec3(1.0); }

    /// What `relativeRadiance` counts in, W·m⁻²·sr⁻¹.
    const glm::dvec3& unit() const { return unit_; }

    /// What the disc of the sun adds to a ray from `point`; 0 beside it. W·m⁻²·sr⁻¹.
    glm::dvec3 discRadiance(const glm::dvec3& point, const glm::dvec3& direction) const;

    /// Share of the sun's light that the environment lets through to a point. Clouds, fog and surfaces are not of it.
    glm::dvec3 sunTransmittance(const glm::dvec3& /*point*/) const { return glm::dvec3(1.0); }

    /// Whether there is light of the sun.
    bool sunny() const { return sunny_; }

    /// ∫ L dω over the disc, W·m⁻².
    const glm::dvec3& sunFluence() const { return sunFluence_; }

    /// The unit vector towards the middle of the disc.
    const glm::dvec3& sunDirection() const { return sunDirection_; }

    /// 1 − cos of the disc's angular radius: 2π times it is the disc's solid angle.
    double sunCone() const { return sunCone_; }

    /// The disc's angular radius in radians.
    double sunRadius() const { return sunRadius_; }

    /// The direction to a point of the disc, all of them equally likely. Draws one number more where the disc is no
    /// point.
    glm::dvec3 sampleSun(Random& random) const;

  private:
    glm::dvec3 unit_;
    glm::dvec3 sunDirection_;
    double sunRadius_;
    double sunCone_;
    glm::dvec3 sunFluence_;
    glm::dvec3 discRadiance_{0.0};  ///< 0 also for a sun that is a point
    bool sunny_;
};

}  // namespace lumulus::reference
