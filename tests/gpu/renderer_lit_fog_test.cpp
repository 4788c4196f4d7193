// Fog in the light of sun and sky: known answers of its pass and of the light that it leaves for clouds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "light/fog_light/fog_light.h"
#include "render/renderer.h"
#include "scene/sunlight.h"
#include "support/small_scene.h"
#include "view/camera.h"

namespace lumulus {
namespace {

using test::smallScene;

/// Haze that thins out upwards over a bright layer on the ground.
scene::Scene hazy() {
    scene::Scene scene = smallScene();
    scene.fog.media.resize(2);
    scene.fog.media[0] = {.kind = scene::MediumKind::exponential,
                          .scattering = {1e-3, 1.2e-3, 1.5e-3},
                          .absorption = glm::dvec3(1e-4),
                          .g = 0.8,
                          .falloff = 0.004,
                          .bottom = -100.0};
    scene.fog.media[1] = {.scattering = glm::dvec3(2e-3), .g = 0.6, .bottom = -100.0, .top = 50.0};
    scene.camera.position = {700.0, 30.0, 0.0};
    scene.camera.target = glm::dvec3(0.0, 100.0, 0.0);
    return scene;
}

TEST(LitFog, IsSeenAsTheTransportOfItsLightSays) {
    scene::Scene scene = hazy();
    scene.clouds.clear();
    Renderer renderer(scene, {.device = "", .validation = true});
    const LayeredImage image = renderer.draw();
    const fog_light::FogLight light(
        *fog_light::layersOf(scene.fog),
        {.toSun = scene.sun.directionTo, .sun = scene.sun.irradiance, .sky = scene.sky.radiance});
    const Camera camera = makeCamera(scene.camera, scene.image, renderer.bounds());
    for (int y = 0; y < 24; y += 3)
        for (int x = 0; x < 32; x += 3) {
            const Ray ray = camera.ray(x + 0.5, y + 0.5);
            const double seen = static_cast<double>(image.layers.at("G")[static_cast<std::size_t>(y * 32 + x)]);
            EXPECT_NEAR(seen / light.radiance(ray.origin.y, ray.direction).g, 1.0, 2e-3) << x << " " << y;
        }
    EXPECT_TRUE(renderer.statistics().validationMessages.empty());
}

/// A sky of one radiance round all that scatters and does not absorb is all that is seen.
TEST(LitFog, FurnaceOfFogCloudAndSkyShowsTheSky) {
    scene::Scene scene = hazy();
    scene.fog.media[0].absorption = glm::dvec3(0.0);
    scene.sun.irradiance = glm::dvec3(0.0);
    scene.sky.radiance = {1.0, 2.0, 3.0};
    scene.photonMap.photons = 40000;
    const LayeredImage image = test::render(scene).image;
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const double seen = static_cast<double>(image.layers.at("G")[i]);
        EXPECT_NEAR(seen, 2.0, image.layers.at("cloud.A")[i] > 0.0F ? 0.2 : 0.01);
        sum += seen;
    }
    EXPECT_NEAR(sum / static_cast<double>(image.pixels()), 2.0, 0.01);
}

TEST(LitFog, ACloudOfAlmostNothingChangesNothing) {
    scene::Scene scene = hazy();
    scene.clouds[0].extinction = 1e-9;
    const LayeredImage with = test::render(scene).image;
    scene.clouds.clear();
    const LayeredImage without = test::render(scene).image;
    for (std::size_t i = 0; i < with.pixels(); ++i)
        ASSERT_NEAR(with.layers.at("G")[i] / without.layers.at("G")[i], 1.0F, 1e-4F);
}

/// Under an atmosphere, fog that is hardly there changes nothing: seen from within and from above, with the cloud above
/// the fog, half in it, and in it. At the horizon the planet is flat as long as the eye is in the fog.
TEST(LitFog, FogOfAlmostNothingLeavesTheAtmosphere) {
    scene::Scene scene = smallScene();
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sun.irradiance = scene::sunAboveAir;
    scene.sky.aerosolDepth = 1e-4;
    scene.sun.angularDiameter = 0.0;
    scene.ground = scene::Ground{glm::dvec3(0.3), -100.0};
    scene.photonMap.photons = 40000;
    for (const double top : {-20.0, 100.0, 600.0})
        for (const double eye : {60.0, 300.0}) {
            scene.fog.media.clear();
            scene.camera.position = {700.0, eye, 0.0};
            scene.camera.target = glm::dvec3(0.0, 100.0, 0.0);
            const LayeredImage clear = test::render(scene).image;
            scene.fog.media = {{.scattering = glm::dvec3(1e-12), .bottom = -100.0, .top = top}};
            const test::Frame foggy = test::render(scene);
            EXPECT_THAT(foggy.passes(), testing::Contains("lit fog"));
            const Camera camera = makeCamera(scene.camera, scene.image, Bounds{});
            double seen = 0.0, expected = 0.0;
            for (std::size_t i = 0; i < clear.pixels(); ++i) {
                const auto with = static_cast<double>(foggy.image.layers.at("G")[i]);
                const auto without = static_cast<double>(clear.layers.at("G")[i]);
                if (clear.layers.at("cloud.A")[i] > 0.0F) {
                    seen += with, expected += without;
                } else if (std::abs(camera.ray(16.0, static_cast<double>(i / 32) + 0.5).direction.y) > 0.05) {
                    EXPECT_NEAR(with / without, 1.0, 0.03) << top << " " << eye << " " << i;
                }
            }
            EXPECT_NEAR(seen / expected, 1.0, 0.02) << top << " " << eye;  // 40000 photons: 0.005
        }
}

}  // namespace
}  // namespace lumulus
