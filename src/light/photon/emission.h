#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "scene/scene.h"
#include "sky/environment.h"

namespace lumulus::photon {

/// Rec. 709.
double luminance(const glm::dvec3& rgb);

/// How a generation is shared out between the lights.
struct Emission {
    double sunShare = 0.0;    ///< of the photons, by luminous power
    glm::dvec3 sunFlux{0.0};  ///< through the cloud's box [W]
    glm::dvec3 skyFlux{0.0};
    double skyPeak = 1.0;  ///< largest weight of a photon of the sky
    bool dark() const { return sunFlux + skyFlux == glm::dvec3(0.0); }

    /// Sun photons in a generation of `photons`: the share, rounded up or down with the right probability by `u` in
    /// [0,1).
    std::uint64_t sunPhotons(std::uint64_t photons, double u) const;
    /// Power of one photon [W]; zero where the light has no share.
    glm::dvec3 sunPower(std::uint64_t photons) const;
    glm::dvec3 skyPower(std::uint64_t photons) const;
};

/// Light that enters a box whose faces have these area vectors [m²] (one of each pair).
Emission makeEmission(const scene::Sun& sun, const sky::Environment& environment, const glm::dmat3& faceArea);

struct AirLight;
/// The same under an atmosphere; `sun` has the most of it that reaches the box.
Emission makeEmission(const scene::Sun& sun, const AirLight& air, const glm::dmat3& faceArea);
/// Light of which a photon stands for `area` [m²] at most, across its direction, from wherever it comes.
Emission makeEmission(const scene::Sun& sun, const sky::Environment& environment, double area);

/// The same under an atmosphere, whose light is for that area (forArea()).
Emission makeEmission(const scene::Sun& sun, const AirLight& air, double area);

/// Greatest flux [W] of a channel through the cloud's box, wherever the sun stands: so the ring's unit does not depend
/// on it, and pictures under a sun that came there have the bits of those where it always was. `irradiance`: of the
/// sun.
double greatestFlux(const glm::dvec3& irradiance, const Emission& emission, const glm::dmat3& faceArea);

/// The same through several clouds that show this area [m²], where the emission is that of photons which stand for up
/// to `each` [m²].
double greatestFlux(const glm::dvec3& irradiance, const Emission& emission, double area, double each);

/// Area vectors [m²] of the faces across x, y and z of a box of `size` voxels with the given edges (columns) [m]. They
/// point the way of the edges, in a mirrored volume too.
glm::dmat3 faceAreas(const glm::dmat3& voxelEdges, const glm::dvec3& size);

}  // namespace lumulus::photon
