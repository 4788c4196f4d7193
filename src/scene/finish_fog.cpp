#include "scene/finish_fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtx/component_wise.hpp>

#include "base/error.h"
#include "scene/aerosol.h"
#include "scene/entry.h"
#include "scene/fog_bounds.h"

namespace lumulus::scene {
namespace {

void checkFilter(const Fog& fog, const Settings& settings) {
    const Entry entry{"fog.", "fog", settings};
    if (fog.filterSize % 2 != 0) {
        throw InputError(fmt::format("filter_size must be 2, 4 or 6, got {}", fog.filterSize),
                         entry.whereOf("filter_size"), "leave it out for 4");
    }
    if (fog.near == fog.far) {
        throw InputError("near and far are the same distance",
                         entry.whereOf(settings.find("fog.far") != nullptr ? "far" : "near"),
                         "give the distances where the z-buffer is 0 and 1");
    }
}

bool isLayer(MediumKind kind) {
    return kind == MediumKind::homogeneous || kind == MediumKind::exponential;
}

void checkKeys(const FogMedium& medium, const Entry& entry) {
    const bool sized = medium.kind == MediumKind::ellipsoid || medium.kind == MediumKind::box;
    for (const char* key : {"falloff", "direction", "offset"})
        entry.checkRead(key, medium.kind == MediumKind::exponential, "\"exponential\"");
    for (const char* key : {"bottom", "top"})
        entry.checkRead(key, isLayer(medium.kind), "\"homogeneous\" or \"exponential\"");
    entry.checkRead("center", sized || medium.kind == MediumKind::sphere, "\"sphere\", \"ellipsoid\" or \"box\"");
    entry.checkRead("radius", medium.kind == MediumKind::sphere, "\"sphere\"");
    entry.checkRead("half_size", sized, "\"ellipsoid\" or \"box\"");
}

void finishMedium(FogMedium& medium, const std::optional<double>& ground, const Entry& entry) {
    checkKeys(medium, entry);
    medium.direction = entry.unitVector("direction", medium.direction);
    if (!(glm::compMin(medium.halfSize) > 0.0))
        throw InputError("half_size must be above 0", entry.whereOf("half_size"), "give lengths, as [100, 50, 100]");
    if (!(medium.bottom < medium.top))
        throw InputError(fmt::format("the medium's bottom {:g} is not below its top {:g}", medium.bottom, medium.top),
                         entry.whereOf("bottom"), "give a lower one");
    if (ground) endAtGround(medium, *ground);
}

void requireVisibility(const char* key, const Entry& entry) {
    if (entry.settings.find(entry.path + "visibility") == nullptr)
        throw InputError(fmt::format("{} needs a visibility", key), entry.whereOf(key), "give visibility, in metres");
}

/// Splits an extinction into scattering and absorption.
void split(glm::dvec3 extinction, const glm::dvec3& albedo, FogMedium& medium) {
    medium.scattering = albedo * extinction;
    medium.absorption = (1.0 - albedo) * extinction;
}

/// The same of the extinction that a visibility has given.
void fillWith(const Aerosol& aerosol, FogMedium& medium, const Entry& entry) {
    requireVisibility("aerosol", entry);
    split(medium.scattering * relativeExtinction(aerosol), glm::dvec3(aerosol.albedo), medium);
    medium.g = aerosol.g;
}

/// Height of what the scene has below its clouds.
std::optional<double> groundHeight(const Scene& scene) {
    if (scene.ground) return scene.ground->height;
    if (scene.sky.groundBelowClouds) return std::nullopt;  // groundedScene() ends the fog
    return scene.sky.model == SkyModel::atmosphere ? std::optional(0.0) : std::nullopt;
}

}  // namespace

void finishFog(Draft& draft, const Settings& settings) {
    Scene& scene = draft.scene;
    checkFilter(scene.fog, settings);
    for (std::size_t i = 0; i < scene.fog.media.size(); ++i) {
        const Entry entry{fmt::format("fog.media.{}.", i), "medium", settings};
        finishMedium(scene.fog.media[i], groundHeight(scene), entry);
        const auto aerosol = draft.aerosols.find(i);
        if (aerosol != draft.aerosols.end()) fillWith(aerosols.at(aerosol->second), scene.fog.media[i], entry);
        const auto albedo = draft.fogAlbedos.find(i);
        if (albedo == draft.fogAlbedos.end()) continue;
        requireVisibility("albedo", entry);
        split(scene.fog.media[i].scattering, albedo->second, scene.fog.media[i]);
    }
}

}  // namespace lumulus::scene
