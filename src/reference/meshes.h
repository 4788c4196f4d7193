#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "mesh/placed.h"
#include "reference/facets.h"
#include "scene/scene.h"
#include "view/camera.h"

namespace lumulus::reference {

/// A point of a mesh on a ray.
struct MeshHit {
    double metres = 0.0;
    std::size_t instance = 0;
    std::size_t triangle = 0;  ///< of its model
    glm::dvec2 place{0.0};     ///< shares of the second and third corner
};

/// What is at a point of a mesh. Normals are unit vectors on the side that the ray comes from.
struct MeshPoint {
    glm::dvec3 faceNormal{0.0, 1.0, 0.0};  ///< of the triangle
    glm::dvec3 normal{0.0, 1.0, 0.0};      ///< that light is reflected about
    Facets facets;
    glm::dvec3 emission{0.0};  ///< W·m⁻²·sr⁻¹
};

/// The meshes of a scene, whose triangles Embree finds. Immutable; any number of threads may ask.
class Meshes {
  public:
    /// Errors: those of mesh::loadMeshes; Error where Embree fails.
    explicit Meshes(const scene::Scene& scene);

    bool empty() const { return tree_ == nullptr; }
    /// The nearest point in front of the ray's origin and nearer than `most` metres. The origin is a point of the
    /// triangle `from`, which does not count, or of none.
    std::optional<MeshHit> nearest(const Ray& ray, double most, const MeshHit* from) const;
    MeshPoint at(const Ray& ray, const MeshHit& hit) const;
    /// How the facets at a point reflect.
    FacetReflection reflection(const MeshPoint& point) const { return {point.facets, energy_}; }
    /// Null without a mesh.
    const mesh::Placed* placed() const { return placed_.get(); }

  private:
    struct Tree;

    std::shared_ptr<const mesh::Placed> placed_;  ///< shared by copies
    std::shared_ptr<const Tree> tree_;            ///< null without a mesh
    FacetEnergy energy_;
};

}  // namespace lumulus::reference
