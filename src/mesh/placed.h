#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "mesh/model.h"
#include "scene/scene.h"

namespace lumulus::mesh {

/// Instances of a scene at most.
inline constexpr std::size_t mostInstances = 65535;

/// A model in the world.
struct Instance {
    std::size_t model = 0;    ///< of Placed::models
    glm::dmat4 toWorld{1.0};  ///< scaled alike along all axes, rotated and moved
};

/// The meshes of a scene. Instances of the same file share a model.
struct Placed {
    std::vector<Model> models;
    std::vector<Instance> instances;  ///< in the order of the scene and of the rows of its files

    bool empty() const { return instances.empty(); }
};

/// Loads the meshes of a scene. Errors: those of loadGltf(); InputError for a bad file of places, and for more than
/// mostInstances.
Placed loadMeshes(const scene::Scene& scene);

}  // namespace lumulus::mesh
