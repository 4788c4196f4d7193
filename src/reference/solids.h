#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "reference/meshes.h"
#include "reference/random.h"
#include "reference/surfaces.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// The first point of a surface or a mesh on a ray.
struct SolidHit {
    double metres = 0.0;
    std::size_t surface = Surfaces::none;  ///< or none
    std::optional<MeshHit> mesh;           ///< or absent
};

/// A point of a surface or a mesh that a path has reached, or of neither.
struct SolidPoint {
    std::size_t surface = Surfaces::none;
    glm::dvec3 normal{0.0};  ///< on the side that the path comes from
    std::optional<MeshHit> mesh;
    MeshPoint facets;  ///< of a mesh
};

/// All that is opaque in a scene: analytic surfaces, lamps as black spheres behind them, meshes. Surfaces reflect by
/// the cosine, meshes by their facets.
class Solids {
  public:
    /// `glow`: whether meshes give off light of their own. Errors: those of Meshes.
    Solids(const scene::Scene& scene, bool glow);

    bool empty() const { return surfaces_.empty() && meshes_.empty(); }
    const Meshes& meshes() const { return meshes_; }
    /// Surfaces that are no lamps.
    std::size_t things() const { return things_.size(); }
    /// The nearest point in front of the ray's origin, which is `from` or in the open.
    std::optional<SolidHit> nearest(const Ray& ray, const SolidPoint& from) const;
    bool block(const Ray& ray, const SolidPoint& from) const { return !empty() && nearest(ray, from).has_value(); }
    /// Metres to the nearest point from the open, lamps left out.
    std::optional<double> thing(const Ray& ray) const;
    /// What is where a ray along `direction` meets `hit`, at `place`.
    SolidPoint at(const glm::dvec3& direction, const glm::dvec3& place, const SolidHit& hit) const;

    /// Share of the light that a surface reflects; 1 for a mesh, whose colours are in shade().
    glm::dvec3 albedo(const SolidPoint& point) const;
    /// Radiance of a mesh, W·m⁻²·sr⁻¹; that of surfaces is known by Lamps.
    glm::dvec3 meshEmission(const Ray& ray, const SolidHit& hit) const;
    /// Draws the direction in which a path along `arrived` goes on.
    glm::dvec3 turn(const SolidPoint& point, const glm::dvec3& arrived, Random& random) const;
    /// Density with which a direction is drawn there, 1/sr.
    double density(const SolidPoint& point, const glm::dvec3& arrived, const glm::dvec3& direction) const;
    /// BRDF times cosine, over density() and albedo(), by channel: 1 for a surface.
    glm::dvec3 shade(const SolidPoint& point, const glm::dvec3& arrived, const glm::dvec3& direction) const;

  private:
    Surfaces surfaces_;  ///< lamps included
    Surfaces things_;    ///< without lamps, which layers do not know
    Meshes meshes_;
    bool glow_;
};

}  // namespace lumulus::reference
