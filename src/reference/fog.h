#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>

#include "reference/fog_media.h"

namespace lumulus::reference {

/// The fog of a scene without air. Free paths are exact.
///
/// Where extinction differs between channels, a free path is drawn for one of them, chosen by the throughput, and its
/// density is the mean over that choice (Veach 1997, the balance heuristic): the sum of a throughput's channels never
/// grows, whatever the coefficients.
class Fog {
  public:
    explicit Fog(const scene::Fog& fog);

    bool empty() const { return media_.empty(); }
    bool hasFog() const { return !empty(); }

    /// RGB transmittance from the ray's origin to `metres` (infinity is allowed).
    glm::dvec3 transmittance(const Ray& ray, double metres) const;

    /// The same of what counts as a thing of its own and not as part of the sky: here all of it.
    glm::dvec3 fogTransmittance(const Ray& ray, double metres) const { return transmittance(ray, metres); }
    bool isFog(std::size_t /*medium*/) const { return true; }

    /// The first collision of light of this throughput before `limit` metres, if there is one.
    std::optional<HazeCollision> collide(const Ray& ray, double limit, const glm::dvec3& throughput,
                                         Random& random) const;

    /// The throughput of a path that reached `metres` without a collision with fog, as `collide` has drawn it.
    glm::dvec3 passed(const Ray& ray, double metres, const glm::dvec3& throughput) const;

    /// The throughput after the collision, absorption included.
    glm::dvec3 scattered(const Ray& ray, const HazeCollision& collision, const glm::dvec3& throughput) const;

    /// Estimates the radiance that the fog emits towards the ray's origin, W·m⁻²·sr⁻¹. `metres` is the end of a path
    /// that `collide` drew, or a nearer place where something stopped it.
    glm::dvec3 emitted(const Ray& ray, double metres, const glm::dvec3& throughput, Random& random) const;

    const PhaseFunction& phase(std::size_t medium) const { return media_[medium].phase; }

  private:
    FogMedia<glm::dvec3> media_;
};

}  // namespace lumulus::reference
