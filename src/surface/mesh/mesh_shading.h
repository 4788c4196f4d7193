#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "prefilter/cube_map.h"
#include "surface/material/energy.h"
#include "surface/mesh/lamp_shading.h"
#include "surface/mesh/ray_tracer.h"
#include "surface/mesh/sun_field.h"

namespace lumulus::surface {

/// The light in which meshes stand.
struct MeshLight {
    prefilter::CubeMap around;  ///< sky, clouds, fog and ground about the middle of all meshes, without the sun
    SunField sun;
    glm::dvec3 toSun{0.0, 1.0, 0.0};
    double sunRadius = 0.0;                      ///< of its disc, radians
    std::shared_ptr<const LampShading> lamps{};  ///< null: none shines
};

/// A point that is seen.
struct MeshSample {
    MeshPoint point;
    glm::dvec3 toEye{0.0};    ///< unit vector
    std::uint32_t pixel = 0;  ///< number that its random numbers differ by
    std::uint32_t first = 0;  ///< of the pixel's directions, those `first`, `first + step`, … are of this sample
    std::uint32_t step = 1;
    std::uint32_t directions = 64;  ///< of the pixel
};

/// Light that meshes send to the eye: of the sun by a ray to its disc, of all else by rays that are drawn by the
/// material (GGX by visible normals, and cosines), which meet the surroundings, read as blurred as there are few of
/// them (Křivánek and Colbert 2008), or another point of a mesh: that one is lit by the sun and by a direction of its
/// own, which nothing hides.
class MeshShading {
  public:
    /// All outlive this object.
    MeshShading(const MeshScene& scene, RayTracer& tracer, MeshLight& light)
        : scene_(scene), tracer_(tracer), light_(light), energy_(material::Microfacets::ggx) {}

    /// Radiance of each sample [W/(m² sr)]. Deterministic. Errors: what `check` throws.
    std::vector<glm::dvec3> shade(std::span<const MeshSample> samples, const RunGpu& run, const Check& check);

  private:
    struct Gathered;

    std::vector<glm::dvec3> sunlight(std::span<const MeshSample> samples, const RunGpu& run, const Check& check);
    void gather(std::span<const MeshSample> samples, std::vector<glm::dvec3>& radiance, const RunGpu& run,
                const Check& check);
    shared::MeshRay rayFrom(const MeshPoint& point, const glm::dvec3& direction) const;
    glm::dvec3 around(const glm::dvec3& direction, double density, std::uint32_t directions) const;
    template <class Add>
    void addLamps(std::span<const MeshSample> samples, const Add& add) const;
    glm::dvec3 beyond(const MeshSample& sample) const;

    const MeshScene& scene_;
    RayTracer& tracer_;
    MeshLight& light_;
    material::EnergyTable energy_;
};

}  // namespace lumulus::surface
