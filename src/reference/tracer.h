#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "reference/majorant.h"
#include "reference/medium.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// One path from the eye.
struct PathSample {
    glm::dvec3 radiance{0.0};  ///< of light that the cloud scattered, W·m⁻²·sr⁻¹
    bool passed = false;       ///< the path met nothing: the sky behind is seen
    bool lost = false;         ///< ended by the limit of collisions
};

/// Transmittance of the medium along the ray, an unbiased estimate by ratio tracking (Novák et al. 2014): the weight,
/// `weight` at the start, falls at each tentative collision by the share of null ones; below `threshold` Russian
/// roulette lifts it back to the threshold or ends it at 0.
double ratioTrack(const Medium& medium, const MajorantGrid& majorants, const VoxelRay& ray, Random& random,
                  double weight, double threshold);

/// The unbiased path tracer of one cloud under the sun and a constant sky: delta tracking, next-event estimation to the
/// sun's disc at each collision by ratio tracking, the sky where a path escapes, any number of scatterings. Immutable;
/// any number of threads may trace.
class PathTracer {
  public:
    /// `volume` null: a scene without a cloud. Errors: InputError for a phase function that is none.
    PathTracer(const scene::Scene& scene, const vdb::Volume* volume, Majorant majorant);

    PathSample trace(const Ray& ray, Random& random) const;

    /// Transmittance and mean distance without noise.
    LineIntegrals integrate(const Ray& ray) const;

    /// Metres to the nearest point of the ray where there is cloud; absent where there is none.
    std::optional<double> front(const Ray& ray) const;

    /// What the disc of the sun adds to a ray that meets nothing; 0 beside it.
    glm::dvec3 discRadiance(const glm::dvec3& direction) const;

    const glm::dvec3& sky() const { return sky_; }

  private:
    struct Cloud {
        Medium medium;
        MajorantGrid majorants;
        PhaseFunction phase;
        glm::dvec3 albedo;
    };

    bool scatter(glm::dvec3& throughput, Random& random) const;
    double sunTransmission(const glm::dvec3& point, const glm::dvec3& direction, double strength, Random& random) const;

    std::optional<Cloud> cloud_;
    glm::dvec3 sky_;
    glm::dvec3 sunDirection_;
    glm::dvec3 sunFluence_;  ///< ∫ L dω over the disc, W·m⁻²
    glm::dvec3 sunRadiance_{0.0};
    double sunCone_;  ///< 1 − cos of the disc's angular radius
    bool sunny_;
};

}  // namespace lumulus::reference
