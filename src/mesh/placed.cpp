#include "mesh/placed.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "base/error.h"
#include "mesh/gltf.h"
#include "scene/places.h"

namespace lumulus::mesh {

Placed loadMeshes(const scene::Scene& scene) {
    Placed placed;
    std::map<std::filesystem::path, std::size_t> known;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const scene::Mesh& mesh = scene.meshes[i];
        const auto [found, isNew] = known.try_emplace(mesh.gltf, placed.models.size());
        const glm::dmat4 own = scene::Place{mesh.position, mesh.yaw, mesh.scale}.transform();
        if (mesh.instances.empty()) {
            placed.instances.push_back({found->second, own});
        } else {
            const scene::Places places =
                scene::readPlaces(mesh.instances, mostInstances - std::min(mostInstances, placed.instances.size()));
            if (places.count > places.rows.size())
                throw InputError(fmt::format("there are more than {} meshes", mostInstances), mesh.instances.string(),
                                 "leave rows out");
            for (const scene::Place& place : places.rows)
                placed.instances.push_back({found->second, place.transform() * own});
        }
        if (isNew) placed.models.push_back(loadGltf(mesh.gltf));
    }
    return placed;
}

}  // namespace lumulus::mesh
