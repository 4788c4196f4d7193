#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

Mesh& meshOf(Draft& d) {
    return d.scene.meshes.at(d.entry);
}

}  // namespace

std::vector<Key> meshKeys() {
    return {
        other("mesh.gltf", Type::path, "(needed)", "Name of a glTF 2.0 file (.glb or .gltf), in metres, +Y up.",
              [](Draft& d, const Value& v) { meshOf(d).gltf = (d.folder / v.text).lexically_normal(); }),
        other("mesh.name", Type::text, "(its index)", "Name of the mesh, for messages and `--set mesh.NAME.yaw=90`.",
              [](Draft& d, const Value& v) { meshOf(d).name = v.text; }),
        other("mesh.position", Type::vector, "[0.0, 0.0, 0.0]", "Where the origin of the file lies, in metres.",
              [](Draft& d, const Value& v) { meshOf(d).position = v.vector; }),
        number("mesh.yaw", {-1e6, 1e6}, "0.0", "Rotation about the vertical in degrees, clockwise seen from above.",
               [](Draft& d, const Value& v) { meshOf(d).yaw = v.number; }),
        number("mesh.scale", {0.0, 1e6, true}, "1.0", "Factor of all lengths.",
               [](Draft& d, const Value& v) { meshOf(d).scale = v.number; }),
        other("mesh.instances", Type::path, "(none: one mesh, where it is)",
              "Name of a CSV file of places as that of `cloud.instances`, without `extinction`: a mesh for each row, "
              "scaled and rotated about the origin after its own place, and then moved. At most 65536 of all meshes.",
              [](Draft& d, const Value& v) { meshOf(d).instances = (d.folder / v.text).lexically_normal(); }),
    };
}

}  // namespace lumulus::scene
