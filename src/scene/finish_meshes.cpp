#include "scene/finish_meshes.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/check_file.h"
#include "scene/entry_name.h"

namespace lumulus::scene {

void finishMeshes(const Draft& draft, const Settings& settings) {
    const std::vector<Mesh>& meshes = draft.scene.meshes;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Entry entry{fmt::format("mesh.{}.", i), "mesh", settings};
        checkEntryName(meshes, i, entry, "a mesh", "every mesh");
        if (meshes[i].gltf.empty())
            throw InputError("the mesh has no file", entry.path + "gltf", "give gltf = \"FILE.glb\"");
        checkFile(meshes[i].gltf, entry.path + "gltf", "a glTF file", draft.allowed, settings);
        checkFile(meshes[i].instances, entry.path + "instances", "a CSV file of places", draft.allowed, settings);
    }
}

}  // namespace lumulus::scene
