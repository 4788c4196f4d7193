#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "reference/air.h"
#include "reference/air_sky.h"
#include "reference/aureole.h"
#include "reference/clouds.h"
#include "reference/environment.h"
#include "reference/fog.h"
#include "reference/lamps.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "reference/sight.h"
#include "reference/solids.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// Stands for no limit of scatterings.
inline constexpr int allScatterings = std::numeric_limits<int>::max();

/// One path from the eye.
struct PathSample {
    glm::dvec3 radiance{0.0};  ///< of all light except the sky and sun directly behind, W·m⁻²·sr⁻¹
    /// Of the sky directly behind, in Environment::unit: where the path met nothing, or met air before anything else.
    glm::dvec3 passed{0.0};
    glm::dvec3 lamps{0.0};  ///< of lamps of the scene that the path met first, in place of `radiance`
    bool lost = false;      ///< ended by the limit of collisions
    int events = 0;         ///< that it went through
};

/// What light is made of: three channels of a sky without air, or four wavelengths in the air of an atmosphere. There
/// may be fog in both.
template <typename Light>
struct WorldOf;

template <>
struct WorldOf<glm::dvec3> {
    using Sky = Environment;
    using Haze = Fog;
};

template <>
struct WorldOf<Four> {
    using Sky = AirSky;
    using Haze = Air;
};

/// The unbiased path tracer of clouds, haze (analytic fog, and the air of an atmosphere) and opaque solids (surfaces,
/// meshes) under the sun and the sky: delta tracking in the clouds and exact free paths in the haze, whichever is
/// nearer, next-event estimation to the sun's disc at each collision (ratio tracking through the clouds, the
/// transmittance of the haze) and to spheres that give off light, both weighted against meeting them by chance (Veach
/// 1997, the balance heuristic), the sky where a path escapes, the emission of surfaces and fog where a path meets
/// them, any number of scatterings. Immutable; any number of threads may trace.
template <typename Light>
class BasicPathTracer {
  public:
    using Sky = typename WorldOf<Light>::Sky;
    using Haze = typename WorldOf<Light>::Haze;

    /// `volumes`: one for each cloud of the scene, read here only. Errors: InputError for a phase function that is
    /// none, and for endless fog in the light of sun and sky.
    /// `scatterings`: what light has been scattered or reflected more often does not count.
    /// `meshesGlow`: whether meshes give off light of their own.
    BasicPathTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
                    int scatterings = allScatterings, bool meshesGlow = true);

    PathSample trace(const Ray& ray, Random& random) const;

    /// As integrateRay() and frontOf().
    RayIntegrals integrate(const Ray& ray) const { return integrateRay(clouds_, solids_, haze_, ray); }
    std::optional<double> front(const Ray& ray) const { return frontOf(clouds_, solids_, ray); }

    /// What a ray sees of the sun's disc, over `discUnit`.
    glm::dvec3 discSeen(const Ray& ray) const;
    /// What a ray sees of the shining lamp of this number, W·m⁻²·sr⁻¹; 0 where it does not meet it first.
    glm::dvec3 lampSeen(const Ray& ray, std::size_t lamp) const;
    /// What `discSeen` counts in, W·m⁻²·sr⁻¹.
    glm::dvec3 discUnit() const;

    const Sky& environment() const { return environment_; }
    const Meshes& meshes() const { return solids_.meshes(); }
    bool hazy() const { return !haze_.empty(); }

  private:
    enum class Place { eye, cloud, haze, solid, sky };

    /// A point from which a path goes on.
    struct Vertex {
        Place place = Place::eye;
        std::size_t index = Surfaces::none;  ///< of the cloud, or the medium of the haze
        glm::dvec3 arrived{0.0};             ///< direction of the path up to here
        Ray ray;                             ///< from here on, in the world
        CloudRays voxels;                    ///< the same for each cloud
        SolidPoint solid;                    ///< what it is of a surface or mesh
    };

    /// An unfinished path.
    struct Path {
        Vertex vertex;
        Light throughput{1.0};
        int collisions = 0;   ///< with clouds
        int scatterings = 0;  ///< so far, reflections included
    };

    /// What a path has found.
    struct Found {
        Light radiance{0.0};
        Light passed{0.0};  ///< of the sky directly behind, in Environment::unit
        Light lamps{0.0};   ///< that the path met first
        bool air = false;   ///< the path met air before anything else
    };

    /// The next event of a path; infinitely far if that is the sky.
    struct Event {
        Place place = Place::sky;
        double metres = std::numeric_limits<double>::infinity();
        std::size_t index = Surfaces::none;  ///< of the cloud, or the medium of the haze
        SolidHit solid;
    };

    Event nextEvent(const Vertex& vertex, const Light& throughput, Random& random) const;
    void meetHaze(Event& event, const Vertex& vertex, const Light& throughput, Random& random) const;
    void meetClouds(Event& event, const Vertex& vertex, Random& random) const;
    void arrive(Vertex& vertex, const Event& event) const;
    double crossHaze(const Vertex& vertex, const Event& event, Light& radiance, Light& throughput,
                     Random& random) const;
    double scatter(const Vertex& vertex, Light& throughput) const;
    const PhaseFunction& phaseAt(const Vertex& vertex) const;
    glm::dvec3 turn(const Vertex& vertex, Random& random) const;
    double response(const Vertex& vertex, const glm::dvec3& toLight) const;
    Light hue(const Path& path, const glm::dvec3& toLight) const;
    double density(const Vertex& vertex, const glm::dvec3& direction) const;
    bool head(Path& path, const glm::dvec3& direction, Random& random) const;
    void branch(const Path& path, std::vector<Path>& branches, Random& random) const;
    PathSample sampleOf(const Found& found) const;
    bool step(Path& path, Found& found, std::vector<Path>& branches, Random& random) const;
    Light emissionAt(const Vertex& vertex, const Event& event) const;
    Light lampLight(const Path& path, Random& random) const;
    Light skyByChance(const Vertex& vertex) const;
    Light skyLight(const Path& path, Random& random) const;
    Light sunByChance(const Vertex& vertex) const;
    Light sunTransmission(const Path& path, double strength, Random& random) const;
    bool isLit(const Vertex& vertex) const {
        return inscattering_ || vertex.place != Place::haze || !haze_.isFog(vertex.index);
    }

    Sky environment_;
    Clouds clouds_;
    std::optional<Aureole> aureole_;
    Haze haze_;
    Solids solids_;
    Lamps lamps_;
    int scatterings_;
    bool inscattering_;  ///< the fog scatters light straight from sun and sky
};

using PathTracer = BasicPathTracer<glm::dvec3>;
/// Of scenes whose sky is an atmosphere.
using AirTracer = BasicPathTracer<Four>;

extern template class BasicPathTracer<glm::dvec3>;
extern template class BasicPathTracer<Four>;

}  // namespace lumulus::reference
