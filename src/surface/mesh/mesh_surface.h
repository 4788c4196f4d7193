#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "mesh/bvh/world.h"
#include "mesh/placed.h"
#include "surface/material/material.h"
#include "view/camera.h"

namespace lumulus::surface {

/// What is where a ray meets a mesh. Normals are unit vectors on the side that the ray comes from.
struct MeshPoint {
    glm::dvec3 position{0.0};    ///< metres
    glm::dvec3 faceNormal{0.0};  ///< of the triangle
    glm::dvec3 normal{0.0};      ///< of vertices and normal map
    material::Material material;
    glm::dvec3 emission{0.0};  ///< W·m⁻²·sr⁻¹
    int instance = -1;         ///< in the order of the scene
    int triangle = -1;         ///< as shared::MeshHit has it
};

/// Where a ray meets a mesh.
struct MeshMeeting {
    shared::MeshHit hit;
    double metres = 0.0;  ///< from the ray's origin
};

/// The meshes of a scene with their trees. It never changes.
struct MeshScene {
    mesh::Placed placed;
    bvh::World world;
    std::vector<glm::dmat3> normalToWorld;  ///< of each instance
    bool masked = false;                    ///< some material has holes

    /// Errors: those of mesh::loadMeshes and bvh::buildWorld.
    MeshScene(const scene::Scene& scene, const Check& check);

    /// Where a ray along `direction` meets what `hit` says. `hit.instance` ≥ 0.
    MeshPoint at(const shared::MeshHit& hit, const glm::dvec3& direction) const;
    /// What a ray meets first up to `metres`, on the host, holes of masks left out. The triangle that it leaves does
    /// not count; −1: none.
    std::optional<MeshMeeting> meet(const Ray& ray, double metres, int fromInstance = -1, int fromTriangle = -1) const;
    /// Whether the mask of the material has no hole there.
    bool isThere(const shared::MeshHit& hit) const;
};

}  // namespace lumulus::surface
