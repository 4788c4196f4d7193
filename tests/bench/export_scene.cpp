// A scene for other renderers: export_scene SCENE FOLDER [section.key=value…] writes FOLDER/scene.json, all values
// filled in, and FOLDER/cloud.vdb, the density over its maximum, for scripts/study/run cycles. In both, lengths are
// in units of 100 m and z points up, as Blender has them (it drops scattering weaker than 1e-5 per unit); directions
// too.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "scene/load.h"
#include "support/first_volume.h"
#include "vdb/write.h"
#include "view/camera.h"

namespace lumulus {

namespace {

using Json = nlohmann::ordered_json;

constexpr double unit = 100.0;  // metres

/// From y up to z up.
glm::dvec3 zUp(const glm::dvec3& v) {
    return {v.x, -v.z, v.y};
}

Json vectorJson(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

/// The density over its maximum, as Cycles reads it. It puts voxel (i,j,k) at (i+½, …), so the grid moves by half a
/// voxel; and it cuts off the skirts of the interpolation where no voxel is active, so the cloud gets a ring of the
/// smallest values. The outermost voxels of a Volume are zero: the ring has room.
vdb::Volume forCycles(vdb::Volume volume) {
    const std::vector<float> original = volume.density;
    constexpr float tiny = 1e-30F;
    for (int z = 0; z < volume.size.z; ++z)
        for (int y = 0; y < volume.size.y; ++y)
            for (int x = 0; x < volume.size.x; ++x) {
                float& value = volume.density[volume.index(x, y, z)];
                value /= volume.maximum;
                if (value > 0.0F) continue;
                for (int k = 0; k < 27 && value == 0.0F; ++k) {
                    const glm::ivec3 n = glm::ivec3(x, y, z) + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1;
                    const bool inside =
                        glm::all(glm::greaterThanEqual(n, glm::ivec3(0))) && glm::all(glm::lessThan(n, volume.size));
                    if (inside && original[volume.index(n.x, n.y, n.z)] > 0.0F) value = tiny;
                }
            }
    vdb::Affine& to = volume.toWorld;
    to.translation = zUp(to.vector(glm::dvec3(-0.5)) + to.translation) / unit;
    for (int axis = 0; axis < 3; ++axis) to.linear[axis] = zUp(to.linear[axis]) / unit;
    volume.maximum = 1.0F;
    return volume;
}

Json sceneJson(const scene::Scene& scene, const vdb::Volume& volume) {
    const scene::Cloud& cloud = scene.clouds.at(0);
    if (scene.camera.projection != scene::Projection::perspective)
        throw InputError("only perspective cameras are exported", "camera.projection", "give a perspective one");
    if (cloud.phase.model != scene::PhaseModel::henyeyGreenstein)
        throw InputError("Cycles 3.4 has Henyey-Greenstein only", "cloud.0.phase", "override it with one");
    const Camera camera = makeCamera(scene.camera, scene.image, boundsOf(volume));
    const double extinction = cloud.extinction * cloud.densityScale * static_cast<double>(volume.maximum);
    return {{"width", camera.width},
            {"height", camera.height},
            {"exposure", scene.image.exposure},
            {"position", vectorJson(zUp(camera.position) / unit)},
            {"right", vectorJson(zUp(camera.axes[0]))},
            {"up", vectorJson(zUp(camera.axes[1]))},
            {"forward", vectorJson(zUp(camera.axes[2]))},
            {"vertical_fov_degrees", scene.camera.verticalFov},
            {"sun_direction_to", vectorJson(zUp(scene.sun.directionTo))},
            {"sun_irradiance", vectorJson(scene.sun.irradiance)},
            {"sun_angular_diameter_degrees", scene.sun.angularDiameter},
            {"sky_radiance", vectorJson(scene.sky.radiance)},
            {"extinction_per_unit", extinction * unit},
            {"albedo", vectorJson(cloud.albedo)},
            {"g", cloud.phase.g}};
}

void run(const std::string& path, const std::filesystem::path& folder, const std::vector<std::string>& overrides) {
    const scene::Scene scene = scene::loadScene(path, overrides);
    if (scene.clouds.empty()) throw InputError("there is no cloud to export", path, "give the scene one");
    const vdb::Volume volume = test::firstVolume(scene);
    const std::string json = sceneJson(scene, volume).dump(2) + "\n";
    std::filesystem::create_directories(folder);
    vdb::write(forCycles(volume), folder / "cloud.vdb");
    writeFile(folder / "scene.json", std::as_bytes(std::span(json)));
}

}  // namespace

}  // namespace lumulus

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("usage: export_scene SCENE FOLDER [section.key=value…]\n", stderr);
        return 2;
    }
    try {
        lumulus::run(argv[1], argv[2], {argv + 3, argv + argc});
    } catch (const std::exception& e) {
        std::fprintf(stderr, "export_scene: %s\n", e.what());
        return 1;
    }
    return 0;
}
