#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/haze_collision.h"
#include "reference/medium.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "scene/fog.h"
#include "view/camera.h"

namespace lumulus::reference {

/// The fog of a scene: all media together, up to `sky_distance` from the eye. Free paths are exact: the first collision
/// of each medium is found by the inverse of its integral, and the nearest one counts.
///
/// Where extinction differs between channels, a free path is drawn for one of them, chosen by the throughput, and its
/// density is the mean over that choice (Veach 1997, the balance heuristic): the sum of a throughput's channels never
/// grows, whatever the coefficients.
class Fog {
  public:
    Fog(const scene::Fog& fog, const glm::dvec3& eye);

    bool empty() const { return media_.empty(); }

    /// RGB transmittance from the ray's origin to `metres` (infinity is allowed).
    glm::dvec3 transmittance(const Ray& ray, double metres) const;

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
    struct Part {
        scene::FogMedium medium;
        glm::dvec3 extinction;  ///< 1/m at ϱ = 1
        PhaseFunction phase;
    };

    Interval reach(const Ray& ray) const;
    glm::dvec3 opticalDepth(const Ray& ray, double metres) const;
    glm::dvec3 relativeTransmittance(const Ray& ray, double metres, const glm::dvec3& throughput) const;

    std::vector<Part> media_;
    glm::dvec3 eye_;
    double skyDistance_;
};

}  // namespace lumulus::reference
