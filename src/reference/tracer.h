#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "reference/aureole.h"
#include "reference/clouds.h"
#include "reference/environment.h"
#include "reference/fog.h"
#include "reference/lamps.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "reference/surfaces.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// One path from the eye.
struct PathSample {
    glm::dvec3 radiance{0.0};  ///< of all light except the sky and sun directly behind, W·m⁻²·sr⁻¹
    glm::dvec3 passed{0.0};    ///< of the sky directly behind, where the path met nothing; in Environment::unit
    bool lost = false;         ///< ended by the limit of collisions
};

/// Integrals along a ray, without noise.
struct RayIntegrals {
    glm::dvec3 transmittance{1.0};  ///< of everything: clouds, fog and surfaces
    double clear = 1.0;             ///< transmittance of clouds and surfaces alone
    double distance = 0.0;          ///< to clouds and surfaces: over 1 − clear, their mean distance. Metres
};

/// The unbiased path tracer of clouds, analytic fog and opaque surfaces under the sun and the sky: delta
/// tracking in the clouds and exact free paths in the fog, whichever is nearer, next-event estimation to the sun's disc
/// at each collision (ratio tracking through the clouds, closed form through the fog) and to spheres that give off
/// light, both weighted against meeting them by chance (Veach 1997, the balance heuristic), the sky where a path
/// escapes, the emission of surfaces and fog where a path meets them, any number of scatterings. Immutable; any number
/// of threads may trace.
class PathTracer {
  public:
    /// `volumes`: one for each cloud of the scene, read here only. `eye`: the fog ends at its `sky_distance` from
    /// there. Errors: InputError for a phase function that is none.
    PathTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
               const glm::dvec3& eye = glm::dvec3(0.0));

    PathSample trace(const Ray& ray, Random& random) const;

    RayIntegrals integrate(const Ray& ray) const;

    /// Metres to the nearest point of cloud or surface on the ray; absent if there is none.
    std::optional<double> front(const Ray& ray) const;

    const Environment& environment() const { return environment_; }
    bool hasFog() const { return !fog_.empty(); }

  private:
    enum class Place { eye, cloud, fog, surface, sky };

    /// A point from which a path goes on.
    struct Vertex {
        Place place = Place::eye;
        std::size_t index = Surfaces::none;  ///< of the surface, the cloud, or the fog's medium
        glm::dvec3 arrived{0.0};             ///< direction of the path up to here
        Ray ray;                             ///< from here on, in the world
        CloudRays voxels;                    ///< the same for each cloud
        glm::dvec3 normal{0.0};              ///< of the surface, on the side that is lit

        std::size_t surface() const { return place == Place::surface ? index : Surfaces::none; }
    };

    /// An unfinished path.
    struct Path {
        Vertex vertex;
        glm::dvec3 throughput{1.0};
        int collisions = 0;  ///< with clouds
    };

    /// The next event of a path; infinitely far if that is the sky.
    struct Event {
        Place place = Place::sky;
        double metres = std::numeric_limits<double>::infinity();
        std::size_t index = Surfaces::none;
    };

    Event nextEvent(const Vertex& vertex, const glm::dvec3& throughput, Random& random) const;
    void arrive(Vertex& vertex, const Event& event) const;
    double crossFog(const Vertex& vertex, const Event& event, glm::dvec3& radiance, glm::dvec3& throughput,
                    Random& random) const;
    double scatter(const Vertex& vertex, glm::dvec3& throughput) const;
    const PhaseFunction& phaseAt(const Vertex& vertex) const;
    glm::dvec3 turn(const Vertex& vertex, Random& random) const;
    double response(const Vertex& vertex, const glm::dvec3& toLight) const;
    glm::dvec3 hue(const Path& path, const glm::dvec3& toLight) const;
    double density(const Vertex& vertex, const glm::dvec3& direction) const;
    bool head(Path& path, const glm::dvec3& direction, Random& random) const;
    void branch(const Path& path, std::vector<Path>& branches, Random& random) const;
    bool step(Path& path, PathSample& sample, std::vector<Path>& branches, Random& random) const;
    glm::dvec3 emissionAt(const Vertex& vertex, const Event& event) const;
    glm::dvec3 lampLight(const Path& path, Random& random) const;
    glm::dvec3 sunByChance(const Vertex& vertex) const;
    glm::dvec3 sunTransmission(const Path& path, double strength, Random& random) const;
    bool isLit(const Vertex& vertex) const { return vertex.place != Place::fog || inscattering_; }

    Environment environment_;
    Clouds clouds_;
    std::optional<Aureole> aureole_;
    Fog fog_;
    Surfaces surfaces_;
    Lamps lamps_;
    bool inscattering_;  ///< the fog scatters light straight from sun and sky
};

}  // namespace lumulus::reference
