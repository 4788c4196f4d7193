#include "scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/text.h"
#include "scene/alternatives.h"
#include "scene/check_field.h"
#include "scene/check_file.h"
#include "scene/entry.h"
#include "scene/file_sequence.h"
#include "scene/finish_fog.h"
#include "scene/finish_lamps.h"
#include "scene/finish_meshes.h"
#include "scene/finish_sky.h"
#include "scene/phase_table_file.h"
#include "scene/sun_and_moon.h"

namespace lumulus::scene {
namespace {

constexpr std::int64_t maximumPixels = std::int64_t{1} << 25;

/// The place of the first of `paths` that has a value.
std::string whereOf(const Settings& settings, std::initializer_list<const char*> paths) {
    for (const char* path : paths) {
        if (const Setting* setting = settings.find(path)) return setting->where;
    }
    return *paths.begin();
}

void checkAlternatives(const Settings& settings) {
    for (const auto& [path, setting] : settings.all()) {
        for (const auto& [a, b] : alternatives) {
            if (setting.key->name != a) continue;
            const std::string other = pathBeside(path, a, b);
            if (settings.find(other) == nullptr) continue;
            throw InputError(fmt::format("{} and {} exclude each other", path, other), settings.find(other)->where,
                             "give one of them");
        }
    }
}

void checkImage(const Image& image, const Settings& settings) {
    if (static_cast<std::int64_t>(image.width) * image.height > maximumPixels) {
        throw InputError(
            fmt::format("the picture has {} × {} pixels, more than {}", image.width, image.height, maximumPixels),
            whereOf(settings, {"image.width", "image.height"}), "make it smaller");
    }
}

void checkCamera(const Camera& camera, const Settings& settings) {
    const double upLength = glm::length(camera.up);
    if (!(upLength > 1e-12)) {
        throw InputError("up must have a length", whereOf(settings, {"camera.up"}), "give a direction, as [0, 1, 0]");
    }
    if (!camera.position || !camera.target) return;
    const glm::dvec3 view = *camera.target - *camera.position;
    if (!(glm::length(view) > 1e-9)) {
        throw InputError("position and target of the camera are the same point", whereOf(settings, {"camera.target"}),
                         "move one of them");
    }
    if (glm::length(glm::cross(view / glm::length(view), camera.up / upLength)) < 1e-6) {
        throw InputError("up is parallel to the view", whereOf(settings, {"camera.up", "camera.target"}),
                         "give another up, as [0, 0, -1] for a view straight down");
    }
}

/// Refuses parameters that the model does not use, unless --set has replaced the file's model.
void checkPhase(const Phase& phase, const std::string& cloud, const Settings& settings) {
    const bool readsG = phase.model == PhaseModel::henyeyGreenstein || phase.model == PhaseModel::schlick;
    const bool readsDiameter = phase.model == PhaseModel::droplet;
    const Setting* model = settings.find(cloud + ".phase.model");
    const auto check = [&](const char* key, bool read, const char* models) {
        const std::string path = cloud + key;
        const Setting* given = settings.find(path);
        if (given == nullptr || read || (given->fromFile && model != nullptr && !model->fromFile)) return;
        throw InputError(fmt::format("{} has no effect: the phase function is {}", path,
                                     model == nullptr ? "henyey-greenstein" : model->node->value_or("another")),
                         given->where, fmt::format("leave it out, or choose the model {}", models));
    };
    check(".phase.g", readsG, "henyey-greenstein or schlick");
    check(".phase.droplet_diameter", readsDiameter, "droplet");
    check(".phase.effective_radius", phase.model == PhaseModel::mie, "mie");
    check(".phase.effective_variance", phase.model == PhaseModel::mie, "mie");
    check(".phase.table", phase.model == PhaseModel::table, "table");
}

void finishSurface(Surface& surface, std::size_t index, const Settings& settings) {
    const Entry entry{fmt::format("surface.{}.", index), "surface", settings};
    entry.checkRead("normal", surface.kind != SurfaceKind::sphere, "\"plane\" or \"disc\"");
    entry.checkRead("radius", surface.kind != SurfaceKind::plane, "\"sphere\" or \"disc\"");
    surface.normal = entry.unitVector("normal", surface.normal);
}

/// Reads the table of a phase function once, so that what is wrong with it is said with the key.
void checkPhaseTable(const Phase& phase, const std::string& cloud, std::span<const std::filesystem::path> allowed,
                     const Settings& settings) {
    if (phase.model != PhaseModel::table) return;
    const std::string where = whereOf(settings, {(cloud + ".phase.table").c_str(), (cloud + ".phase.model").c_str()});
    if (phase.table.empty())
        throw InputError("the model table needs a file", where, "give table = \"FILE\" of angles and values");
    if (!isAllowed(phase.table, allowed))
        throw InputError(fmt::format("{} does not exist", phase.table.string()), where,
                         "give a file, its path relative to the scene file");
    try {
        readPhaseTable(phase.table);
    } catch (const PhaseTableError& e) {
        throw InputError(fmt::format("{}: {}", e.place, e.fault), where, e.mend);
    }
}

void checkSkyMap(Scene& scene, std::span<const std::filesystem::path> allowed, const Settings& settings) {
    if (scene.sky.model != SkyModel::map) {
        for (const char* key : {"sky.map", "sky.map_scale", "sky.map_rotation", "sky.map_sun"}) {
            const Setting* given = settings.find(key);
            if (given == nullptr ||
                (given->fromFile && settings.find("sky.model") != nullptr && !settings.find("sky.model")->fromFile))
                continue;
            throw InputError(fmt::format("{} has no effect", key), given->where,
                             "leave it out, or write sky.model = \"map\"");
        }
        return;
    }
    const std::filesystem::path& map = scene.sky.map;
    std::error_code ec;
    const bool exists = map.empty() || (isAllowed(map, allowed) && std::filesystem::exists(map, ec));
    if (!exists || std::filesystem::is_directory(map, ec)) {
        throw InputError(fmt::format("{} {}", map.string(), exists ? "is a folder" : "does not exist"),
                         whereOf(settings, {"sky.map"}), "give an EXR file, its path relative to the scene file");
    }
    if (settings.find("sun.irradiance") == nullptr) scene.sun.irradiance = glm::dvec3(0.0);
}

/// Whether `--set cloud.NAME.key` can mean nothing but the cloud of that name.
bool isName(const std::string& name) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto allowed = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; };
    return !name.empty() && name.size() <= 64 && letter(name[0]) && std::ranges::all_of(name, allowed) &&
           findKey("cloud." + name) == nullptr && !isSection("cloud." + name);
}

void checkName(const std::vector<Cloud>& clouds, std::size_t index, const Settings& settings) {
    const std::string path = fmt::format("cloud.{}.name", index);
    const Setting* given = settings.find(path);
    if (given == nullptr) return;
    const std::string& name = clouds[index].name;
    if (!isName(name)) {
        throw InputError(fmt::format("\"{}\" cannot be the name of a cloud", shortened(oneLine(name), 80)),
                         given->where, "give letters, digits, - and _, a letter first, and not the name of a key");
    }
    const auto same = std::ranges::find(clouds, name, &Cloud::name);
    if (same != clouds.begin() + static_cast<std::ptrdiff_t>(index)) {
        throw InputError(fmt::format("cloud.{} has the name \"{}\" already", same - clouds.begin(), name), given->where,
                         "give every cloud a name of its own");
    }
}

}  // namespace

Scene finishScene(Draft draft, const Settings& settings) {
    checkAlternatives(settings);
    checkImage(draft.scene.image, settings);
    checkCamera(draft.scene.camera, settings);
    finishSunAndMoon(draft, settings);
    finishSky(draft, settings);
    checkSkyMap(draft.scene, draft.allowed, settings);
    finishSunDistance(draft, settings);
    for (std::size_t i = 0; i < draft.scene.clouds.size(); ++i) {
        Cloud& cloud = draft.scene.clouds[i];
        const std::string path = fmt::format("cloud.{}", i);
        chooseFile(cloud, draft.frame, draft.fps, draft.allowed, whereOf(settings, {(path + ".vdb").c_str()}));
        checkName(draft.scene.clouds, i, settings);
        checkPhase(cloud.phase, path, settings);
        checkPhaseTable(cloud.phase, path, draft.allowed, settings);
        checkFile(cloud.vdb, path + ".vdb", "an OpenVDB file", draft.allowed, settings);
        checkFile(cloud.instances, path + ".instances", "a CSV file of places", draft.allowed, settings);
    }
    for (std::size_t i = 0; i < draft.scene.fields.size(); ++i) {
        checkField(draft.scene, i, settings);
        checkPhase(draft.scene.fields[i].phase, fmt::format("field.{}", i), settings);
        checkPhaseTable(draft.scene.fields[i].phase, fmt::format("field.{}", i), draft.allowed, settings);
    }
    finishFog(draft, settings);
    for (std::size_t i = 0; i < draft.scene.surfaces.size(); ++i) finishSurface(draft.scene.surfaces[i], i, settings);
    finishLamps(draft, settings);
    finishMeshes(draft, settings);
    draft.scene.seconds = draft.frame / draft.fps;
    return std::move(draft.scene);
}

}  // namespace lumulus::scene
