#include "service/render/describe_scene.h"

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
    if (!scene.clouds.empty()) {
        result.asymmetry = result.originalClouds[0].asymmetry;
    }
    result.centre = renderer.bounds().centre;
    result.radius = renderer.bounds().radius();
    return result;
}

}  // namespace lumulus::service
