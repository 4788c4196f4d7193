#include "reference/environment.h"

#include <glm/gtx/component_wise.hpp>
#include <utility>

namespace lumulus::reference {
namespace {

std::optional<SkyMap> mapOf(const scene::Sky& sky) {
    if (sky.model != scene::SkyModel::map) return std::nullopt;
    return SkyMap(sky);
}

}  // namespace

Environment::Environment(const scene::Scene& scene) : Environment(scene, mapOf(scene.sky)) {}

Environment::Environment(const scene::Scene& scene, std::optional<SkyMap> map)
    : Environment(scene.sky, map, map && map->sun() ? *map->sun() : scene.sun) {}

Environment::Environment(const scene::Sky& sky, std::optional<SkyMap> map, const scene::Sun& sun)
    : map_(std::move(map)),
      unit_(map_ ? glm::dvec3(1.0) : sky.radiance),
      sun_(sun),
      sunFluence_(sun.irradiance * sun_.fluence()),
      meanDiscRadiance_(sun.irradiance * sun_.meanRadiance()),
      sunny_(glm::compMax(sunFluence_) > 0.0) {}

}  // namespace lumulus::reference
