#include "scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "scene/alternatives.h"

namespace lumulus::scene {
namespace {

constexpr std::int64_t maximumPixels = std::int64_t{1} << 25;

/// Place of the first of `paths` that somebody gave.
std::string whereOf(const Settings& settings, std::initializer_list<const char*> paths) {
    for (const char* path : paths) {
        if (const Setting* setting = settings.find(path)) return setting->where;
    }
    return *paths.begin();
}

void checkAlternatives(const Settings& settings) {
    for (const auto& [a, b] : alternatives) {
        if (settings.find(std::string(a)) != nullptr && settings.find(std::string(b)) != nullptr) {
            throw InputError(fmt::format("{} and {} exclude each other", a, b), settings.find(std::string(b))->where,
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

void finishSun(Draft& draft, const Settings& settings) {
    if (draft.directionTo) {
        const double length = glm::length(*draft.directionTo);
        if (!(length > 1e-12)) {
            throw InputError("direction_to must have a length", whereOf(settings, {"sun.direction_to"}),
                             "give a direction towards the sun, as [0, 1, 0]");
        }
        draft.scene.sun.directionTo = *draft.directionTo / length;
    } else if (draft.azimuth || draft.elevation) {
        draft.scene.sun.directionTo =
            skyDirection(draft.azimuth.value_or(defaultAzimuth), draft.elevation.value_or(defaultElevation));
    }
}

/// A parameter that the model does not read is a mistake, unless --set has replaced the file's model.
void checkPhase(const Phase& phase, const Settings& settings) {
    const bool readsG = phase.model == PhaseModel::henyeyGreenstein || phase.model == PhaseModel::schlick;
    const bool readsDiameter = phase.model == PhaseModel::droplet;
    const Setting* model = settings.find("cloud.0.phase.model");
    const auto check = [&](const char* path, bool read, const char* models) {
        const Setting* given = settings.find(path);
        if (given == nullptr || read || (given->fromFile && model != nullptr && !model->fromFile)) return;
        throw InputError(fmt::format("{} has no effect: the phase function is {}", path,
                                     model == nullptr ? "henyey-greenstein" : model->node->value_or("another")),
                         given->where, fmt::format("leave it out, or choose the model {}", models));
    };
    check("cloud.0.phase.g", readsG, "henyey-greenstein or schlick");
    check("cloud.0.phase.droplet_diameter", readsDiameter, "droplet");
}

/// Whether the file lies in one of the folders, links followed; anywhere where none are given.
bool isAllowed(const std::filesystem::path& file, std::span<const std::filesystem::path> folders) {
    if (folders.empty()) return true;
    std::error_code ec;
    const std::filesystem::path real = std::filesystem::weakly_canonical(file, ec);
    return !ec && std::ranges::any_of(folders, [&](const std::filesystem::path& folder) {
        const std::filesystem::path base = std::filesystem::weakly_canonical(folder, ec);
        return !ec && std::ranges::mismatch(base, real).in1 == base.end();
    });
}

void checkCloudFile(const Cloud& cloud, std::span<const std::filesystem::path> allowed, const Settings& settings) {
    if (cloud.vdb.empty()) return;
    std::error_code ec;
    const bool exists = isAllowed(cloud.vdb, allowed) && std::filesystem::exists(cloud.vdb, ec);
    if (!exists || std::filesystem::is_directory(cloud.vdb, ec)) {
        throw InputError(fmt::format("{} {}", cloud.vdb.string(), exists ? "is a folder" : "does not exist"),
                         whereOf(settings, {"cloud.0.vdb"}),
                         "give an OpenVDB file, its path relative to the scene file");
    }
}

}  // namespace

Scene finishScene(Draft draft, const Settings& settings) {
    checkAlternatives(settings);
    checkImage(draft.scene.image, settings);
    checkCamera(draft.scene.camera, settings);
    finishSun(draft, settings);
    for (const Cloud& cloud : draft.scene.clouds) {
        checkPhase(cloud.phase, settings);
        checkCloudFile(cloud, draft.allowed, settings);
    }
    return std::move(draft.scene);
}

}  // namespace lumulus::scene
