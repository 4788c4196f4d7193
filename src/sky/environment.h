#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "shared/environment.h"

namespace lumulus::sky {

/// A direction from which light of the environment arrives.
struct EnvironmentSample {
    glm::dvec3 direction{0.0, 1.0, 0.0};  ///< unit vector towards the environment
    glm::dvec3 radiance{0.0};             ///< W/(m² sr) per channel
    double density = 0.0;                 ///< probability density with which it was drawn [1/sr]
};

/// What the air along a ray segment does to light: seen = radiance + transmittance · behind.
struct AerialPerspective {
    glm::dvec3 radiance{0.0};       ///< W/(m² sr) per channel
    glm::dvec3 transmittance{1.0};  ///< per channel
};

/// What surrounds the world. Everybody who needs light of the sky asks here and nowhere else. Its first kind is
/// constant: the same radiance from everywhere, without air. Lengths are metres, directions unit vectors.
class Environment {
  public:
    Environment(const scene::Sky& sky) : radiance_(sky.radiance) {}  // implicit: a scene's sky is an environment

    /// Radiance that arrives from a direction [W/(m² sr)].
    glm::dvec3 radiance(const glm::dvec3& direction) const;
    /// The radiance if it is the same from everywhere, as filters of pictures need to know; here it always is.
    const glm::dvec3& uniformRadiance() const { return radiance_; }
    /// A direction, drawn by two numbers in [0,1).
    EnvironmentSample sample(const glm::dvec2& u) const;
    /// Share of the sun's light that the air lets through to a point, by channel.
    glm::dvec3 sunTransmittance(const glm::dvec3& point, const glm::dvec3& directionTo) const;
    /// What the air does along the ray segment between two points.
    AerialPerspective between(const glm::dvec3& from, const glm::dvec3& to) const;
    /// Flux [W] into a box through all its faces; `faceArea` holds the area vectors of one of each pair of them [m²].
    glm::dvec3 fluxThrough(const glm::dmat3& faceArea) const;
    bool isDark() const;

    shared::EnvironmentParams params() const { return {glm::vec3(radiance_)}; }

  private:
    glm::dvec3 radiance_;
};

}  // namespace lumulus::sky
