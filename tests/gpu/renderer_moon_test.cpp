// A renderer at night: the moon as a second sun, and the night sky behind it.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/render.h"
#include "render/renderer.h"
#include "scene/ephemeris.h"
#include "scene/sunlight.h"
#include "sky/environment.h"
#include "support/sky_pixels.h"
#include "support/small_scene.h"
#include "view/camera.h"
#include "volume/load.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;

const char* const names[3] = {"R", "G", "B"};

scene::Scene sceneAt(double sunElevation, double moonElevation) {
    scene::Scene scene = test::smallScene();
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sun.irradiance = scene::sunAboveAir;
    scene.sun.directionTo = scene::skyDirection(250.0, sunElevation);
    scene.moon.shines = true;
    scene.moon.directionTo = scene::skyDirection(70.0, moonElevation);
    return scene;
}

sky::Environment environmentOf(const scene::Scene& scene) {
    return {scene.sky, scene.ground, scene.sun.angularDiameter, sky::moonOf(scene)};
}

double sumOf(const Frame& frame, const std::string& layer) {
    double sum = 0.0;
    for (const float value : frame.image.layers.at(layer)) sum += static_cast<double>(value);
    return sum;
}

/// A sun in the moon's place and as weak makes the same picture, but for the night sky that goes with the stronger sun.
TEST(RendererMoon, ShinesAsASunInItsPlace) {
    scene::Scene night = sceneAt(-40.0, 35.0);
    night.photonMap.photons = 100000;
    scene::Scene day = night;
    day.moon.shines = false;
    day.sun.directionTo = night.moon.directionTo;
    day.sun.irradiance *= scene::moonShare(0.0);
    const Frame moon = test::render(night), sun = test::render(day);
    for (const char* name : names) {
        const double expected = sumOf(sun, std::string("cloud.") + name);
        EXPECT_GT(expected, 0.0);
        const double night0 = sky::nightLuminance / sky::lumensPerWatt * sumOf(moon, "cloud.A");
        EXPECT_NEAR(sumOf(moon, std::string("cloud.") + name), expected + night0, 0.02 * expected) << name;
    }
}

/// Pixels beside the cloud have the radiance that the environment answers: moonlit air and the night sky.
TEST(RendererMoon, PixelsShowTheMoonlitSky) {
    for (const double sun : {-30.0, -8.0}) {
        SCOPED_TRACE(sun);
        const scene::Scene scene = sceneAt(sun, 30.0);
        test::expectPixelsOfTheSky(scene, environmentOf(scene));
    }
}

/// By day the moon adds nothing that is seen, but photons of the sky start from other places.
TEST(RendererMoon, IsNothingByDay) {
    scene::Scene scene = sceneAt(30.0, 40.0);
    scene.photonMap.photons = 40000;
    const Frame both = test::render(scene);
    scene.moon.shines = false;
    const Frame alone = test::render(scene);
    for (const char* name : names) {
        const double expected = sumOf(alone, std::string("cloud.") + name);
        EXPECT_NEAR(sumOf(both, std::string("cloud.") + name), expected, 5e-3 * expected);
    }
}

/// Against the path tracer, which has paths of its own for the moon; relative to the mean of the cloud's pixels.
TEST(RendererMoon, CloudsAreLitAsByTheReference) {
    scene::Scene scene = sceneAt(-40.0, 35.0);
    scene.image = {16, 12, 0.0};
    scene.clouds[0].transform[3] = glm::dvec4(0.0, 1000.0, 0.0, 1.0);
    scene.photonMap = scene::PhotonMap{};
    scene.photonMap.photons = 200000;
    const Frame frame = test::render(scene);
    const CloudVolumes volumes = loadClouds(
        scene, noReport, [] {}, FieldStorage::dense);
    reference::Renderer truth(scene, volumes.placed(), reference::Majorant::local, 5);
    for (int i = 0; i < 400; ++i) truth.pass([](std::uint64_t) { return true; });
    const LayeredImage exact = truth.picture();
    for (const char* name : names) {
        double seen = 0.0, expected = 0.0, variance = 0.0;
        for (std::size_t i = 0; i < exact.pixels(); ++i) {
            if (exact.layers.at("cloud.A")[i] < 0.1F) continue;
            seen += static_cast<double>(frame.image.layers.at(name)[i]);
            expected += static_cast<double>(exact.layers.at(name)[i]);
            variance += static_cast<double>(exact.layers.at(std::string("variance.") + name)[i]);
        }
        EXPECT_NEAR(seen, expected, 0.01 * expected + 3.0 * std::sqrt(variance)) << name;
        EXPECT_LT(std::sqrt(variance), 0.01 * expected);
    }
}

}  // namespace
}  // namespace lumulus
