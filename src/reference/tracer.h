#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "reference/aureole.h"
#include "reference/fog.h"
#include "reference/lamps.h"
#include "reference/majorant.h"
#include "reference/medium.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "reference/surfaces.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// One path from the eye.
struct PathSample {
    glm::dvec3 radiance{0.0};  ///< of all light except the sky and sun directly behind, W·m⁻²·sr⁻¹
    glm::dvec3 passed{0.0};    ///< weight of the sky directly behind: the path met nothing
    bool lost = false;         ///< ended by the limit of collisions
};

/// Estimates the transmittance of the medium along the ray up to `limit` metres without bias, by ratio tracking (Novák
/// et al. 2014). The weight starts at `weight` and falls at each tentative collision by the share of null collisions.
/// Below `threshold` Russian roulette raises it to the threshold or ends it at 0.
double ratioTrack(const Medium& medium, const MajorantGrid& majorants, const VoxelRay& ray, Random& random,
                  double weight, double threshold, double limit = std::numeric_limits<double>::infinity());

/// Integrals along a ray, without noise.
struct RayIntegrals {
    glm::dvec3 transmittance{1.0};  ///< of everything: cloud, fog and surfaces
    double clear = 1.0;             ///< transmittance of cloud and surfaces alone
    double distance = 0.0;          ///< to cloud and surfaces: over 1 − clear, their mean distance. Metres
};

/// The unbiased path tracer of one cloud, analytic fog and opaque surfaces under the sun and a constant sky. Free paths
/// come from delta tracking in the cloud and from closed forms in the fog; the nearer one counts. Each collision has
/// next-event estimation to the sun's disc (ratio tracking through the cloud, closed form through the fog) and to
/// emitting spheres, both weighted by the balance heuristic against meeting them by chance (Veach 1997). A path that
/// escapes adds the sky, and one that meets surfaces or fog adds their emission. The number of scattering events is not
/// limited. Immutable; any number of threads may trace.
class PathTracer {
  public:
    /// A null `volume` means a scene without a cloud. The fog ends at its `sky_distance` from `eye`.
    /// Errors: InputError for an invalid phase function.
    PathTracer(const scene::Scene& scene, const vdb::Volume* volume, Majorant majorant,
               const glm::dvec3& eye = glm::dvec3(0.0));

    PathSample trace(const Ray& ray, Random& random) const;

    RayIntegrals integrate(const Ray& ray) const;

    /// Metres to the nearest point of cloud or surface on the ray; absent if there is none.
    std::optional<double> front(const Ray& ray) const;

    /// Radiance of the sun's disc in a direction; 0 beside the disc.
    glm::dvec3 discRadiance(const glm::dvec3& direction) const;

    const glm::dvec3& sky() const { return sky_; }
    bool hasFog() const { return !fog_.empty(); }

  private:
    struct Cloud {
        Medium medium;
        MajorantGrid majorants;
        PhaseFunction phase;
        glm::dvec3 albedo;
    };

    enum class Place { eye, cloud, fog, surface, sky };

    /// A point from which a path goes on.
    struct Vertex {
        Place place = Place::eye;
        std::size_t index = Surfaces::none;  ///< index of the surface or of the fog's medium
        glm::dvec3 arrived{0.0};             ///< direction of the path up to here
        Ray ray;                             ///< from here on, in the world
        VoxelRay voxel;                      ///< the same ray in voxel coordinates of the cloud, if there is one
        glm::dvec3 normal{0.0};              ///< of the surface, on the side that is lit

        std::size_t surface() const { return place == Place::surface ? index : Surfaces::none; }
    };

    /// An unfinished path.
    struct Path {
        Vertex vertex;
        glm::dvec3 throughput{1.0};
    };

    /// The next event of a path; infinitely far if that is the sky.
    struct Event {
        Place place = Place::sky;
        double metres = std::numeric_limits<double>::infinity();
        std::size_t index = Surfaces::none;
    };

    Event nextEvent(const Vertex& vertex, const glm::dvec3& throughput, Random& random) const;
    std::optional<double> cloudCollision(const VoxelRay& ray, double limit, Random& random) const;
    void arrive(Vertex& vertex, const Event& event) const;
    double crossFog(const Vertex& vertex, const Event& event, glm::dvec3& radiance, glm::dvec3& throughput,
                    Random& random) const;
    double scatter(const Vertex& vertex, glm::dvec3& throughput) const;
    glm::dvec3 turn(const Vertex& vertex, Random& random) const;
    double response(const Vertex& vertex, const glm::dvec3& toLight) const;
    double density(const Vertex& vertex, const glm::dvec3& direction) const;
    bool head(Path& path, const glm::dvec3& direction, Random& random) const;
    void branch(const Path& path, std::vector<Path>& branches, Random& random) const;
    bool step(Path& path, PathSample& sample, std::vector<Path>& branches, Random& random) const;
    glm::dvec3 emissionAt(const Vertex& vertex, const Event& event) const;
    glm::dvec3 lampLight(const Vertex& vertex, Random& random) const;
    glm::dvec3 sunByChance(const Vertex& vertex) const;
    glm::dvec3 sunTransmission(const Vertex& vertex, double strength, Random& random) const;
    bool isLit(const Vertex& vertex) const { return vertex.place != Place::fog || inscattering_; }

    std::optional<Cloud> cloud_;
    std::optional<Aureole> aureole_;
    Fog fog_;
    Surfaces surfaces_;
    Lamps lamps_;
    bool inscattering_;  ///< the fog scatters light straight from sun and sky
    glm::dvec3 sky_;
    glm::dvec3 sunDirection_;
    glm::dvec3 sunFluence_;  ///< ∫ L dω over the disc, W·m⁻²
    glm::dvec3 sunRadiance_{0.0};
    double sunCone_;  ///< 1 − cos of the disc's angular radius
    bool sunny_;
};

}  // namespace lumulus::reference
