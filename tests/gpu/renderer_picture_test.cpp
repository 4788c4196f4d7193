// Pictures with known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;
using test::smallScene;

class Picture : public testing::TestWithParam<scene::DrawMode> {
  protected:
    scene::Scene scene = smallScene();
    void SetUp() override { scene.draw.mode = GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Modes, Picture, testing::Values(scene::DrawMode::march, scene::DrawMode::billboards),
                         [](const auto& mode) {
                             return mode.param == scene::DrawMode::march ? "march" : "billboards";
                         });

/// Optical depths of parallel rays add up to the extinction mass of the ball: Σ −ln T · pixel area = σt · 4/3 π R³.
TEST_P(Picture, OpticalDepthsAddUpToTheMass) {
    constexpr double height = 300.0, away = 400.0;
    scene.image = {96, 80, 0.0};
    scene.clouds[0].albedo = dvec3(0.0);
    scene.clouds[0].resolution = 34;
    scene.preparation.maxLeaves = 2000;
    scene.camera.projection = scene::Projection::orthographic;
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.camera.position = *scene.camera.target + away * glm::normalize(dvec3(1.0, 0.4, 2.0));
    scene.camera.verticalFov = glm::degrees(2.0 * std::atan(0.5 * height / away));
    const Frame frame = test::render(scene);
    const double pixel = height / scene.image.height;
    double mass = 0.0;
    for (const float t : frame.image.layers.at("transmittance.G"))
        mass -= std::log(static_cast<double>(t)) * pixel * pixel;
    const double exact = scene.clouds[0].extinction * 4.0 / 3.0 * std::numbers::pi * 1e6;
    EXPECT_NEAR(mass, exact, 0.01 * exact);
}

/// A cloud 1e7 m from the origin looks as it does at the origin.
TEST_P(Picture, DoesNotDependOnThePlace) {
    scene.photonMap.forwardCut = 12.0;
    const Frame here = test::render(scene);
    scene.clouds[0].transform[3] = glm::dvec4(1e7, 2e6, -0.7e7, 1.0);
    const Frame there = test::render(scene);
    EXPECT_EQ(here.statistics.events, there.statistics.events);
    for (const auto& [name, values] : here.image.layers) {
        const auto& others = there.image.layers.at(name);
        double squares = 0.0, norm = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            squares += std::pow(static_cast<double>(values[i] - others[i]), 2);
            norm += std::pow(static_cast<double>(values[i]), 2);
        }
        EXPECT_LE(squares, 1e-6 * norm) << name;
    }
}

/// The white furnace cannot be seen: every pixel is the sky.
TEST_P(Picture, WhiteFurnaceIsInvisible) {
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(2.0, 1.0, 0.5);
    scene.photonMap.photons = 1'600'000;
    for (const double cut : {0.0, 12.0}) {
        scene.photonMap.forwardCut = cut;
        const Frame frame = test::render(scene);
        const char* names[3] = {"R", "G", "B"};
        for (int channel = 0; channel < 3; ++channel) {
            double sum = 0.0, worst = 0.0;
            for (const float value : frame.image.layers.at(names[channel])) {
                const double off = static_cast<double>(value) / scene.sky.radiance[channel] - 1.0;
                sum += off;
                worst = std::max(worst, std::abs(off));
            }
            EXPECT_LT(worst, 0.05) << names[channel] << ", cut " << cut;
            EXPECT_LT(std::abs(sum) / static_cast<double>(frame.image.pixels()), 0.005);
        }
    }
}

/// A compositor puts R, G, B over its own sky by A. With the background A is 1; without it the picture is the cloud's
/// own layers, and over the sky it is the picture again.
TEST_P(Picture, CompositesByItsAlpha) {
    scene.sun.irradiance = dvec3(0.0);    // its disc is no part of the sky
    scene.clouds[0].albedo = dvec3(1.0);  // what is seen through it has no colour
    const Frame with = test::render(scene);
    scene.image.background = false;
    const Frame without = test::render(scene);
    const auto& layers = with.image.layers;
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t i = 0; i < with.image.pixels(); ++i) {
        ASSERT_EQ(layers.at("A")[i], 1.0F);
        ASSERT_EQ(without.image.layers.at("A")[i], layers.at("cloud.A")[i]);
        double over = 0.0, whole = 0.0;  // of the mean of the colours, which A belongs to
        for (int c = 0; c < 3; ++c) {
            const float alone = without.image.layers.at(names[c])[i];
            ASSERT_EQ(alone, layers.at(std::string("cloud.") + names[c])[i]);
            over += static_cast<double>(alone) +
                    (1.0 - static_cast<double>(layers.at("cloud.A")[i])) * scene.sky.radiance[c];
            whole += static_cast<double>(layers.at(names[c])[i]);
        }
        ASSERT_NEAR(over, whole, 1e-4 * whole) << i;
    }
    EXPECT_EQ(layers.at("cloud.A").front(), 0.0F);
    EXPECT_GT(layers.at("cloud.A")[layers.at("cloud.A").size() / 2 + 16], 0.1F);
}

/// Light is linear: twice the light makes twice the picture, to the bits that a power of two leaves alone.
TEST_P(Picture, IsLinearInTheLight) {
    const Frame once = test::render(scene);
    scene.sun.irradiance *= 2.0;
    scene.sky.radiance *= 2.0;
    const Frame twice = test::render(scene);
    for (const char* name : {"R", "G", "B", "cloud.R"})
        for (std::size_t i = 0; i < once.image.pixels(); ++i)
            ASSERT_EQ(2.0F * once.image.layers.at(name)[i], twice.image.layers.at(name)[i]) << name;
}

}  // namespace
}  // namespace lumulus
