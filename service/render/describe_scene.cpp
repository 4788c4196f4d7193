#include "service/render/describe_scene.h"

#include <fmt/format.h>

#include "base/version.h"

namespace lumulus::service {

namespace {

std::vector<CloudDescription> cloudsOf(const scene::Scene& scene) {
    std::vector<CloudDescription> clouds;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const scene::Phase& phase = scene.clouds[i].phase;
        const bool readsG =
            phase.model == scene::PhaseModel::henyeyGreenstein || phase.model == scene::PhaseModel::schlick;
        clouds.push_back(
            {scene::nameOf(scene, i), scene.clouds[i].extinction, readsG ? std::optional(phase.g) : std::nullopt});
    }
    return clouds;
}

}  // namespace

void describePicture(LayeredImage& image, const scene::Scene& scene, const Renderer& renderer) {
    image.attributes["scene"] = scene.source;
    image.attributes["seed"] = std::to_string(scene.photonMap.seed);
    image.attributes["software"] = std::string("lumulus ") + version;
    image.attributes["samples"] = std::to_string(renderer.generations().photons());
}

SceneDescription describeScene(const scene::Scene& scene, const Renderer& renderer, const SceneLight& light) {
    SceneDescription result;
    result.name = scene.source;
    result.image = scene.image;
    result.light = light;
    result.seed = scene.photonMap.seed;
    result.generations = renderer.generationsWanted();
    const Statistics statistics = renderer.statistics();
    result.collectors = statistics.collectors;
    result.device = statistics.device;
    result.warnings = statistics.warnings;
    result.originalSun = scene.sun;
    result.originalClouds = cloudsOf(scene);
    result.originalMedia = renderer.fogMedia();
    if (!scene.clouds.empty()) {
        result.asymmetry = result.originalClouds[0].asymmetry;
    }
    result.centre = renderer.bounds().centre;
    result.radius = renderer.bounds().radius();
    return result;
}

std::vector<std::string> repeatOverrides(const scene::Scene& scene, const Renderer& renderer, const MediaKeys& media) {
    const Generations ring = renderer.generations();
    std::vector<std::string> overrides;
    if (ring.count > 0)
        overrides = {fmt::format("photon_map.first_generation={}", ring.first),
                     fmt::format("photon_map.generations={}", ring.count),
                     fmt::format("photon_map.photons={}", ring.photons())};
    const scene::Sun& sun = renderer.sun();
    if (const glm::dvec3 d = sun.directionTo; d != scene.sun.directionTo)
        overrides.push_back(fmt::format("sun.direction_to=[{},{},{}]", d.x, d.y, d.z));
    if (const glm::dvec3 e = sun.irradiance; e != scene.sun.irradiance)
        overrides.push_back(fmt::format("sun.irradiance=[{},{},{}]", e.x, e.y, e.z));
    for (std::size_t i = 0; i < scene.clouds.size(); ++i)
        if (renderer.extinction(i) != scene.clouds[i].extinction)
            overrides.push_back(fmt::format("cloud.{}.extinction={}", i, renderer.extinction(i)));
    for (std::string& one : overridesOf(media)) overrides.push_back(std::move(one));
    return overrides;
}

}  // namespace lumulus::service
