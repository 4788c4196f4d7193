// The ground below the clouds: what it shows, what it hides, and what a scene without one does not pay.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;
using std::numbers::pi;
using test::Frame;

/// A ball of radius 100 m about (0, 100, 0) over a ground, seen from the side.
scene::Scene groundScene(double height = -200.0) {
    scene::Scene scene = test::smallScene();
    scene.ground = scene::Ground{dvec3(0.5, 0.4, 0.2), height};
    scene.camera.position = dvec3(0.0, 200.0, 900.0);
    scene.camera.target = dvec3(0.0, 0.0, 0.0);
    scene.camera.verticalFov = 60.0;
    scene.sun.directionTo = dvec3(0.0, 1.0, 0.0);
    return scene;
}

/// A camera that sees the ground far away from the cloud, or straight below it.
void lookDown(scene::Scene& scene, const dvec3& from) {
    scene.camera.position = from;
    scene.camera.target = from - dvec3(0.0, 1.0, 0.0);
    scene.camera.verticalFov = 1.0;
}

float middleOf(const LayeredImage& image, const char* layer) {
    return image.layers.at(layer)[image.pixels() / 2 + static_cast<std::size_t>(image.width) / 2];
}

TEST(RendererGround, OpenGroundIsLambertUnderSunAndSky) {
    scene::Scene scene = groundScene();
    for (const double elevation : {75.0, 20.0, -5.0}) {
        scene.sun.directionTo = scene::skyDirection(0.0, elevation);
        lookDown(scene, {3e6, 500.0, -2e6});
        scene.camera.up = dvec3(0.0, 0.0, -1.0);
        const Frame frame = test::render(scene);
        const char* names[3] = {"R", "G", "B"};
        for (int c = 0; c < 3; ++c) {
            const double sun = scene.sun.irradiance[c] * std::max(0.0, std::sin(elevation * pi / 180.0));
            const double wanted = scene.ground->albedo[c] / pi * (sun + pi * scene.sky.radiance[c]);
            EXPECT_NEAR(middleOf(frame.image, names[c]), wanted, 1e-5 * wanted) << elevation;
        }
        EXPECT_NEAR(middleOf(frame.image, "depth.Z"), 700.0F, 0.1F);
        EXPECT_NEAR(middleOf(frame.image, "depth.front"), 700.0F, 0.1F);
    }
}

TEST(RendererGround, ReceivesTheShadowOfACloud) {
    scene::Scene scene = groundScene();
    scene.sky.radiance = dvec3(0.0);
    scene.clouds[0].albedo = dvec3(0.0);
    lookDown(scene, {0.0, -100.0, 0.0});  // below the cloud
    scene.camera.up = dvec3(0.0, 0.0, -1.0);
    const Frame frame = test::render(scene);
    // thickness 2 where the ball is whole; its voxels of 12.5 m fade at the rim
    const double open = scene.ground->albedo.x / pi * scene.sun.irradiance.x;
    EXPECT_NEAR(-std::log(middleOf(frame.image, "R") / open), 2.0, 0.1);
}

TEST(RendererGround, HidesCloudsBelowIt) {
    scene::Scene scene = groundScene(100.0);  // through the middle of the ball
    scene.camera.position = dvec3(0.0, 700.0, 1.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    const Frame cut = test::render(scene);
    scene.ground->height = -50.0;
    const Frame whole = test::render(scene);
    const double above = -std::log(middleOf(cut.image, "transmittance.R"));
    EXPECT_NEAR(above, -0.5 * std::log(middleOf(whole.image, "transmittance.R")), 0.02);
}

TEST(RendererGround, LiesBehindTheClouds) {
    const scene::Scene scene = groundScene();
    const Frame frame = test::render(scene);
    const auto& layers = frame.image.layers;
    int ground = 0, sky = 0;
    for (std::size_t i = 0; i < frame.image.pixels(); ++i) {
        const float passed = layers.at("transmittance.R")[i];
        const double behind = (layers.at("R")[i] - layers.at("cloud.R")[i]) / std::max(passed, 1e-6F);
        if (passed < 1.0F) continue;
        const bool isSky = std::abs(behind - scene.sky.radiance.x) < 1e-6;
        (isSky ? sky : ground) += 1;
        EXPECT_EQ(layers.at("depth.Z")[i] > 1e9F, isSky);
    }
    EXPECT_GT(ground, 100);
    EXPECT_GT(sky, 30);
}

TEST(RendererGround, IsSeenThroughFog) {
    scene::Scene scene = groundScene();
    scene.clouds.clear();
    scene.fog.media.resize(1);
    scene.fog.media[0].absorption = dvec3(1e-3);
    scene.fog.media[0].bottom = scene.ground->height;
    scene.fog.media[0].top = scene.ground->height + 2000.0;
    scene.sky.radiance = dvec3(0.0);
    lookDown(scene, {0.0, 500.0, 0.0});
    scene.camera.up = dvec3(0.0, 0.0, -1.0);
    const Frame frame = test::render(scene);
    // down to the ground the sunlight has come through all of the fog, and 700 m on the way back
    const double wanted = scene.ground->albedo.x / pi * scene.sun.irradiance.x * std::exp(-1e-3 * (700.0 + 2000.0));
    EXPECT_NEAR(middleOf(frame.image, "R"), wanted, 1e-3 * wanted);
}

/// A white ground and a cloud that only scatters, in a sky of one colour, are not seen: what the ground sends up, what
/// clouds send down and what is left of the sky add up everywhere.
void expectFurnace(scene::Scene scene) {
    scene.ground->albedo = dvec3(1.0);
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.5, 1.0, 2.0);
    scene.photonMap.photons = 400000;
    const Frame frame = test::render(scene);
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0, worst = 0.0;
        for (const float value : frame.image.layers.at(names[c])) {
            sum += value;
            worst = std::max(worst, std::abs(value / scene.sky.radiance[c] - 1.0));
        }
        EXPECT_NEAR(sum / static_cast<double>(frame.image.pixels()) / scene.sky.radiance[c], 1.0, 0.006);
        EXPECT_LT(worst, 0.12);
    }
}

TEST(RendererGround, IsNotSeenInAWhiteFurnace) {
    scene::Scene scene = groundScene(-20.0);
    scene.camera.position->y = 400.0;
    scene.clouds[0].extinction = 0.03;
    expectFurnace(scene);
    scene.clouds[0].phase.g = 0.5;
    scene.photonMap.forwardCut = 15.0;  // light that goes nearly straight on counts as straight
    expectFurnace(scene);
}

TEST(RendererGround, IsNotSeenInAWhiteFurnaceOfTwoClouds) {
    scene::Scene scene = groundScene(-20.0);
    scene.camera.position->y = 400.0;
    scene.clouds[0].extinction = 0.03;
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[1].transform[3] = glm::dvec4(180.0, 60.0, 40.0, 1.0);
    expectFurnace(scene);
}

TEST(RendererGround, LightsTheBasesOfClouds) {
    scene::Scene scene = groundScene(-50.0);
    scene.camera.position = dvec3(0.0, -40.0, 400.0);
    scene.camera.target = dvec3(0.0, 50.0, 0.0);
    scene.photonMap.photons = 40000;
    const auto cloudIn = [&](const dvec3& albedo) {
        scene.ground->albedo = albedo;
        const Frame frame = test::render(scene);
        double sum = 0.0;
        for (const float value : frame.image.layers.at("cloud.R")) sum += value;
        return sum;
    };
    EXPECT_GT(cloudIn(dvec3(0.8)), 1.2 * cloudIn(dvec3(0.0)));
}

TEST(RendererGround, RefusesACameraBelowIt) {
    scene::Scene scene = groundScene();
    scene.camera.position->y = -201.0;
    try {
        test::render(scene);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("is below the ground at -200 m (camera.position)"));
    }
}

TEST(RendererGround, AddsNoPass) {
    scene::Scene scene = groundScene();
    const std::vector<std::string> with = test::render(scene).passes();
    scene.ground.reset();
    EXPECT_EQ(with, test::render(scene).passes());
}

}  // namespace
}  // namespace lumulus
