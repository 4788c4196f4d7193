// A renderer under an atmosphere: what it records, and light against known answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "render/renderer.h"
#include "scene/sunlight.h"
#include "sky/environment.h"
#include "support/sky_pixels.h"
#include "support/small_scene.h"
#include "view/camera.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;
using testing::Contains;
using testing::Not;

scene::Scene sceneUnder(double elevation) {
    scene::Scene scene = test::smallScene();
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sun.irradiance = scene::sunAboveAir;
    scene.sun.directionTo = scene::skyDirection(70.0, elevation);
    return scene;
}

sky::Environment environmentOf(const scene::Scene& scene) {
    return {scene.sky, scene.ground, scene.sun.angularDiameter};
}

const char* const names[3] = {"R", "G", "B"};

TEST(RendererAtmosphere, RecordsItsPassAndAConstantSkyDoesNot) {
    const Frame frame = test::render(sceneUnder(30.0));
    EXPECT_THAT(frame.passes(), Contains("frame sky"));
    EXPECT_THAT(test::render(test::smallScene()).passes(), Not(Contains("frame sky")));
    for (const auto& [name, values] : frame.image.layers)
        for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
}

/// Pixels beside the cloud have the radiance that the environment answers.
TEST(RendererAtmosphere, PixelsShowTheSkyAndTheGround) {
    for (const double elevation : {40.0, 3.0}) {
        SCOPED_TRACE(elevation);
        const scene::Scene scene = sceneUnder(elevation);
        test::expectPixelsOfTheSky(scene, environmentOf(scene));
    }
}

/// A thin cloud that scatters evenly has the mean radiance of its surroundings, plus E/(4π) of the sun there.
TEST(RendererAtmosphere, AThinCloudShowsTheLightAroundIt) {
    for (const double elevation : {-3.0, 2.0, 30.0}) {
        scene::Scene scene = sceneUnder(elevation);
        scene.clouds[0].extinction = 0.0005;  // an optical thickness of 0.1
        scene.clouds[0].phase.g = 0.0;
        scene.clouds[0].transform[3] = glm::dvec4(0.0, 2000.0, 0.0, 1.0);
        scene.photonMap.photons = 200000;
        const Frame frame = test::render(scene);
        const sky::Environment environment = environmentOf(scene);
        const dvec3 middle(0.0, 2100.0, 0.0);
        const dvec3 sun = environment.sunTransmittance(middle, scene.sun.directionTo) * scene.sun.irradiance;
        const dvec3 expected = environment.meanRadiance(middle, scene.sun) + sun * (0.25 * std::numbers::inv_pi);
        for (int c = 0; c < 3; ++c) {
            double light = 0.0, cover = 0.0;
            const auto& cloud = frame.image.layers.at(std::string("cloud.") + names[c]);
            const auto& alpha = frame.image.layers.at("cloud.A");
            for (std::size_t i = 0; i < cloud.size(); ++i) {
                light += static_cast<double>(cloud[i]);
                cover += static_cast<double>(alpha[i]);
            }
            ASSERT_GT(cover, 1.0);
            EXPECT_NEAR(light / cover, expected[c], 0.05 * expected[c]) << elevation << " " << names[c];
        }
    }
}

/// Twice the sun is twice the picture, bit by bit.
TEST(RendererAtmosphere, ScalesWithTheSun) {
    scene::Scene scene = sceneUnder(15.0);
    const Frame once = test::render(scene);
    scene.sun.irradiance *= 2.0;
    const Frame twice = test::render(scene);
    for (const char* name : names)
        for (std::size_t i = 0; i < once.image.layers.at(name).size(); ++i)
            ASSERT_EQ(twice.image.layers.at(name)[i], 2.0F * once.image.layers.at(name)[i]) << name << " " << i;
}

/// A sun that rises while the renderer lives: what follows is the picture of that sun, as a service shows it.
TEST(RendererAtmosphere, TheSunMayRise) {
    const auto lightOf = [](Renderer& renderer) {
        for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
        const LayeredImage image = renderer.draw();
        double sum = 0.0;
        for (const float value : image.layers.at("cloud.G")) sum += static_cast<double>(value);
        return sum;
    };
    RendererOptions options;
    options.validation = true;
    options.keepRing = true;
    scene::Scene scene = sceneUnder(-4.0);
    scene.photonMap.photons = 40000;
    Renderer renderer(scene, options);
    const double twilight = lightOf(renderer);
    scene.sun.directionTo = scene::skyDirection(70.0, 40.0);
    renderer.setSun(scene.sun.directionTo, scene.sun.irradiance);
    scene.photonMap.firstGeneration = 2;  // those that the other renderer traces next
    Renderer fresh(scene, options);
    const double day = lightOf(renderer), expected = lightOf(fresh);
    EXPECT_GT(twilight, 0.0);
    EXPECT_GT(day, 100.0 * twilight);
    EXPECT_NEAR(day, expected, 1e-4 * expected);
    EXPECT_EQ(renderer.statistics().saturated, 0U);
}

TEST(RendererAtmosphere, RefusesACameraBelowTheGround) {
    scene::Scene scene = sceneUnder(30.0);
    scene.camera.position = dvec3(0.0, -50.0, 500.0);
    EXPECT_THROW(test::render(scene), InputError);
}

/// From orbit, and at night: nothing breaks.
TEST(RendererAtmosphere, IsFiniteFromOrbitAndAtNight) {
    for (const double elevation : {-40.0, 50.0}) {
        scene::Scene scene = sceneUnder(elevation);
        scene.camera.position = dvec3(0.0, 4e5, 0.0);
        scene.camera.target = dvec3(2e6, 0.0, 0.0);
        for (const auto& [name, values] : test::render(scene).image.layers)
            for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name << elevation;
    }
}

/// The ground of a scene is the planet's: the picture is that of a sky with this ground.
TEST(RendererAtmosphere, AGroundIsThatOfThePlanet) {
    scene::Scene ofSky = sceneUnder(30.0), withGround = ofSky;
    ofSky.sky.groundAlbedo = dvec3(0.4);
    withGround.ground = scene::Ground{dvec3(0.4), 0.0};
    const Frame expected = test::render(ofSky), found = test::render(withGround);
    EXPECT_EQ(found.image.layers, expected.image.layers);
}

/// Half the density twice at one place is lit like the whole once: photons of several clouds begin on discs round them,
/// those of one on its box.
TEST(RendererAtmosphere, TwoHalvesAreLitAsTheWhole) {
    scene::Scene once = sceneUnder(20.0);
    once.photonMap.photons = 400000;
    scene::Scene twice = once;
    twice.clouds[0].extinction *= 0.5;
    twice.clouds.push_back(twice.clouds[0]);
    const Frame whole = test::render(once), halves = test::render(twice);
    for (const char* const name : {"cloud.R", "cloud.G", "cloud.B"}) {
        const auto sum = [&](const Frame& frame) {
            double all = 0.0;
            for (const float value : frame.image.layers.at(name)) all += static_cast<double>(value);
            return all;
        };
        EXPECT_NEAR(sum(halves) / sum(whole), 1.0, 0.02) << name;
    }
}

}  // namespace
}  // namespace lumulus
