// Droplets by Mie's theory in pictures: a thin cloud shows their phase functions, colour by colour.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "medium/phase_function.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;

/// A ball of optical thickness 0.02 under a white sun that is scattered by an angle [degrees] towards the eye.
scene::Scene thinBall(double angle) {
    scene::Scene scene = test::smallScene();
    scene.image = {9, 9, 0.0};
    scene.camera.position = dvec3(0.0, 100.0, 5000.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.camera.verticalFov = 0.5;
    const double theta = glm::radians(angle);
    scene.sun.directionTo = dvec3(std::sin(theta), 0.0, -std::cos(theta));
    scene.sun.irradiance = dvec3(1.0);
    scene.sky.radiance = dvec3(0.0);
    scene.clouds[0].extinction = 1e-4;
    scene.clouds[0].phase.model = scene::PhaseModel::mie;
    return scene;
}

dvec3 middleOf(const LayeredImage& image) {
    const auto at = [&](const char* layer) { return static_cast<double>(image.layers.at(layer)[40]); };
    return {at("cloud.R"), at("cloud.G"), at("cloud.B")};
}

TEST(Droplets, AThinCloudShowsTheirColours) {
    const std::vector<phase::PhaseFunction> channels = phase::phaseColours(thinBall(0.0).clouds[0].phase).channels;
    const dvec3 first = middleOf(test::render(thinBall(90.0)).image);
    for (const double angle : {60.0, 135.0, 142.0, 150.0}) {
        const dvec3 seen = middleOf(test::render(thinBall(angle)).image);
        for (int c = 0; c < 3; ++c) {
            const phase::PhaseFunction& p = channels[static_cast<std::size_t>(c)];
            const double expected = p.evaluateAngle(glm::radians(angle)) / p.evaluateAngle(glm::radians(90.0));
            // light that scattered twice is some per cent where p is small
            EXPECT_NEAR(seen[c] / first[c] / expected, 1.0, 0.08) << angle << " " << c;
        }
    }
}

}  // namespace
}  // namespace lumulus
