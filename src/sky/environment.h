#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "scene/scene.h"
#include "shared/environment.h"
#include "sky/atmosphere.h"
#include "sky/map_sky.h"

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

/// What surrounds the world. Everybody who needs light of the sky asks here and nowhere else. A constant sky has the
/// same radiance from everywhere, and no air; an atmosphere is lit by the sun, whose irradiance counts above the air; a
/// map has radiances of its own, and no air. Lengths are metres, directions unit vectors.
class Environment {
  public:
    /// Makes the tables of an atmosphere, or reads a map. `moon`: a second sun of the atmosphere (moonOf()).
    /// `angularDiameter`: of the sun, degrees. `air`: that of an environment of the same sky, ground and diameter;
    /// null: it is made. Errors: those of MapSky.
    Environment(const scene::Sky& sky, const std::optional<scene::Ground>& ground = {}, double angularDiameter = 0.53,
                const std::optional<scene::Sun>& moon = {}, std::shared_ptr<const Atmosphere> air = {});

    /// The air, or null where there is none.
    const Atmosphere* atmosphere() const { return atmosphere_.get(); }
    std::shared_ptr<const Atmosphere> sharedAir() const { return atmosphere_; }
    /// The map, or null where the sky is none.
    const MapSky* map() const { return map_.get(); }
    /// The moon of an atmosphere, where it shines; its irradiance counts above the air.
    const std::optional<scene::Sun>& moon() const { return moon_; }
    /// Whether its light is the same from everywhere.
    bool isConstant() const { return !atmosphere_ && !map_; }
    /// The sun of a scene, or that which was taken out of the map in its stead.
    scene::Sun sunOf(const scene::Sun& sun) const { return map_ && map_->sun() ? *map_->sun() : sun; }

    /// Radiance that arrives at a point from a direction, without the discs of sun and moon [W/(m² sr)].
    glm::dvec3 radiance(const glm::dvec3& point, const glm::dvec3& direction, const scene::Sun& sun) const;
    /// Mean of the radiance over all directions.
    glm::dvec3 meanRadiance(const glm::dvec3& point, const scene::Sun& sun) const;
    /// Share of the sun's light that the air lets through to a point, by channel, with the part of the disc that the
    /// ground hides.
    glm::dvec3 sunTransmittance(const glm::dvec3& point, const glm::dvec3& directionTo) const;
    /// What the air does along the ray segment between two points.
    AerialPerspective between(const glm::dvec3& from, const glm::dvec3& to, const scene::Sun& sun) const;
    /// Whether no light comes from it, with this sun.
    bool isDark(const scene::Sun& sun) const;

    // Of a constant sky.

    /// A direction, drawn by two numbers in [0,1).
    EnvironmentSample sample(const glm::dvec2& u) const;
    /// Flux [W] into a box through all its faces; `faceArea` holds the area vectors of one of each pair of them [m²].
    glm::dvec3 fluxThrough(const glm::dmat3& faceArea) const;
    /// For shaders; black where the sky differs by direction, which passes of its own show.
    shared::EnvironmentParams params() const { return {glm::vec3(radiance_)}; }

  private:
    glm::dvec3 radiance_;
    std::shared_ptr<const Atmosphere> atmosphere_;  ///< immutable; shared by copies
    std::shared_ptr<const MapSky> map_;             ///< as that
    std::optional<scene::Sun> moon_;
};

/// The moon of a scene as a second sun, as large as the first; none where it does not shine, or there is no atmosphere.
std::optional<scene::Sun> moonOf(const scene::Scene& scene);

}  // namespace lumulus::sky
