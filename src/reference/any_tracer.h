#pragma once

#include <optional>
#include <variant>

#include "reference/tracer.h"

namespace lumulus::reference {

/// The path tracer that a scene needs: of four wavelengths where its sky is an atmosphere, else of three channels.
/// Light of a moon has paths of its own, as of another sun; its disc is not drawn.
class AnyTracer {
  public:
    /// As BasicPathTracer.
    AnyTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
              int scatterings = allScatterings);

    PathSample trace(const Ray& ray, Random& random) const;
    RayIntegrals integrate(const Ray& ray) const;
    std::optional<double> front(const Ray& ray) const;
    glm::dvec3 discSeen(const Ray& ray) const;
    glm::dvec3 discUnit() const;
    glm::dvec3 lampSeen(const Ray& ray, std::size_t lamp) const;
    /// Environment::unit.
    glm::dvec3 skyUnit() const;
    const SunDisc& sun() const;
    /// Null without a mesh.
    const mesh::Placed* meshes() const;
    bool sunny() const;
    /// Whether paths meet fog or air, which makes them long.
    bool hazy() const;

  private:
    std::variant<PathTracer, AirTracer> tracer_;
    std::optional<AirTracer> moon_;
};

}  // namespace lumulus::reference
