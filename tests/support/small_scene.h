#pragma once

#include <gtest/gtest.h>

#include "render/renderer.h"

namespace lumulus::test {

/// A ball of radius 100 m about (0, 100, 0), optical thickness 2, that renders in a moment.
inline scene::Scene smallScene() {
    scene::Scene scene;
    scene.image = {32, 24, 0.0};
    scene.clouds.resize(1);
    scene::Cloud& cloud = scene.clouds[0];
    cloud.procedural = "sphere";
    cloud.resolution = 18;
    cloud.extinction = 0.01;
    scene.preparation.samples = 500;
    scene.preparation.maxLeaves = 200;
    scene.photonMap.photons = 4000;
    scene.photonMap.generations = 2;
    scene.photonMap.bands = 3;
    scene.photonMap.forwardCut = 0.0;
    return scene;
}

struct Frame {
    LayeredImage image;
    Statistics statistics;

    std::vector<std::string> passes() const {
        std::vector<std::string> names;
        for (const PassTime& pass : statistics.passes) names.push_back(pass.name);
        return names;
    }
};

/// Renders under validation and synchronisation validation; any message fails the test.
inline Frame render(const scene::Scene& scene) {
    Renderer renderer(scene, {.device = "", .validation = true});
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    Frame frame;
    frame.image = renderer.draw();
    frame.statistics = renderer.statistics();
    for (const std::string& message : frame.statistics.validationMessages) ADD_FAILURE() << message;
    return frame;
}

}  // namespace lumulus::test
