#include "scene/fog_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "base/error.h"

namespace lumulus::scene {
namespace {

/// Sine of the angle to the vertical below which a direction counts as vertical: that of rounding.
constexpr double vertical = 1e-9;

/// Any ground below the clouds is higher.
constexpr double lowestGround = -1e12;

bool isLayer(const FogMedium& medium) {
    return medium.kind == MediumKind::homogeneous || medium.kind == MediumKind::exponential;
}

bool thins(const FogMedium& medium, double upwards) {
    return medium.kind == MediumKind::exponential && medium.falloff > 0.0 && isLevel(medium) &&
           medium.direction.y * upwards > 0.0;
}

bool needsTop(const FogMedium& medium) {
    return isLayer(medium) && !std::isfinite(medium.top) && !thins(medium, 1.0);
}

bool needsBottom(const FogMedium& medium) {
    return isLayer(medium) && !std::isfinite(medium.bottom) && !thins(medium, -1.0);
}

bool isLit(const Scene& scene) {
    return glm::compMax(scene.sun.irradiance) > 0.0 || scene.sky.model != SkyModel::constant ||
           glm::compMax(scene.sky.radiance) > 0.0 || std::ranges::any_of(scene.lamps, &Lamp::shines);
}

}  // namespace

bool isLevel(const FogMedium& medium) {
    if (medium.kind == MediumKind::homogeneous) return true;
    return medium.kind == MediumKind::exponential && std::hypot(medium.direction.x, medium.direction.z) < vertical;
}

void endAtGround(FogMedium& medium, double height) {
    if (isLayer(medium)) medium.bottom = std::min(std::max(medium.bottom, height), medium.top);
}

bool isBounded(const FogMedium& medium) {
    return !needsTop(medium) && !needsBottom(medium);
}

void requireBoundedFog(const Scene& scene) {
    const bool lit = isLit(scene);
    for (std::size_t i = 0; i < scene.fog.media.size(); ++i) {
        FogMedium medium = scene.fog.media[i];
        if (scene.sky.groundBelowClouds) endAtGround(medium, lowestGround);
        const bool extinguishes = glm::compMax(medium.scattering + medium.absorption) > 0.0;
        if (isBounded(medium) || !((lit && extinguishes) || glm::compMax(medium.emission) > 0.0)) continue;
        const std::string path = fmt::format("fog.media.{}", i);
        if (needsTop(medium))
            throw InputError("fog in the light of a sun, a sky or a lamp needs a top", path + ".top",
                             needsBottom(medium) ? "give top and bottom in metres" : "give a height in metres");
        throw InputError("fog in the light of a sky or a lamp needs a bottom", path + ".bottom",
                         "give a height in metres, or [ground] height");
    }
}

}  // namespace lumulus::scene
