// Fog in the frame: its passes exist only where there is fog, and the picture is what the fog makes of the clear one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using test::Frame;
using test::smallScene;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

scene::Scene foggy(double scattering, double absorption) {
    scene::Scene scene = smallScene();
    scene.fog.media.resize(1);
    scene.fog.media[0].scattering = glm::dvec3(scattering);
    scene.fog.media[0].absorption = glm::dvec3(absorption);
    scene.fog.media[0].bottom = -1e3;
    scene.fog.media[0].top = 2e3;
    return scene;
}

/// Fog in a ball, which is shown by the filter.
scene::Scene inABall(double scattering, double absorption) {
    scene::Scene scene = foggy(scattering, absorption);
    scene.fog.media[0] = {.kind = scene::MediumKind::sphere,
                          .scattering = glm::dvec3(scattering),
                          .absorption = glm::dvec3(absorption),
                          .radius = 1e4};
    return scene;
}

double sumOf(const std::vector<float>& values) {
    double sum = 0.0;
    for (const float value : values) sum += static_cast<double>(value);
    return sum;
}

TEST(RendererFog, WithoutMediaNoPassOfItExists) {
    scene::Scene scene = smallScene();
    scene.fog.filter = scene::FogFilter::masked;
    EXPECT_THAT(test::render(scene).passes(), Not(Contains(HasSubstr("fog"))));
    EXPECT_THAT(test::render(scene).passes(), Not(Contains(HasSubstr("frame"))));
}

TEST(RendererFog, TheFrameStaysOnTheGpuUntilItIsSeenThroughTheFog) {
    EXPECT_THAT(test::render(foggy(1e-4, 0.0)).passes(),
                ElementsAre("trace", "sort", "gather", "frame background", "shadow volume", "reconstruct",
                            "light counts", "light field", "march", "frame band", "lit fog", "fog margin", "fog light",
                            "fog down", "fog up", "fog spread", "frame download"));
    EXPECT_THAT(test::render(inABall(1e-4, 0.0)).passes(),
                ElementsAre("trace", "sort", "gather", "frame background", "shadow volume", "reconstruct",
                            "light counts", "light field", "march", "frame band", "fog split", "fog light", "fog down",
                            "fog up", "fog join", "frame download"));
}

TEST(RendererFog, WithoutACloudNothingIsFiltered) {
    scene::Scene scene = inABall(1e-4, 0.0);
    scene.clouds.clear();
    scene.sun.directionTo = {0.0, -1.0, 0.0};
    EXPECT_THAT(test::render(scene).passes(),
                ElementsAre("frame background", "fog split", "fog join", "frame download"));
}

TEST(RendererFog, ATileIsAsInTheWholePicture) {
    scene::Scene scene = foggy(1e-3, 1e-4);
    Renderer renderer(scene, {.device = "", .validation = true});
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    View view = renderer.sceneView();
    const LayeredImage whole = renderer.draw(view);
    view.tile = Tile{5, 7, 11, 13};
    const LayeredImage part = renderer.draw(view);
    for (const auto& [name, values] : part.layers)
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(values[i], whole.layers.at(name)[(i / 11 + 7) * 32 + i % 11 + 5]) << name;
}

TEST(RendererFog, EachFilterRunsCleanUnderValidation) {
    for (const scene::FogFilter filter :
         {scene::FogFilter::scatter, scene::FogFilter::masked, scene::FogFilter::naive, scene::FogFilter::gather}) {
        scene::Scene scene = inABall(1e-4, 1e-5);
        scene.fog.filter = filter;
        const Frame frame = test::render(scene);
        EXPECT_THAT(frame.passes(), Contains("fog light"));
        for (const auto& [name, values] : frame.image.layers)
            for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
    }
}

TEST(RendererFog, AUniformSkyStaysUniformButForWhatIsAbsorbed) {
    scene::Scene scene = foggy(0.001, 2e-5);
    scene.clouds.clear();
    scene.sun.irradiance = glm::dvec3(0.0);
    scene.sky.radiance = glm::dvec3(1.0);
    scene.fog.media[0] = {.absorption = glm::dvec3(2e-5)};  // endless: it is seen up to the sky's distance
    const Frame frame = test::render(scene);
    for (const float value : frame.image.layers.at("R")) ASSERT_NEAR(value, std::exp(-2.0), 1e-5);
}

TEST(RendererFog, FogDimsTheSunAtTheCloud) {
    scene::Scene scene = smallScene();
    scene.sky.radiance = glm::dvec3(0.0);
    scene.sun.directionTo = {0.0, 1.0, 0.0};
    const double clear = sumOf(test::render(scene).image.layers.at("cloud.G"));
    // a thin layer high above cloud and camera: light comes through it on its way down only
    scene.fog.media.resize(1);
    scene::FogMedium& layer = scene.fog.media[0];
    layer.kind = scene::MediumKind::sphere;
    layer.center = {0.0, 50000.0, 0.0};
    layer.radius = 40000.0;
    layer.absorption = glm::dvec3(1.5 / 80000.0);  // optical depth 1 through the middle
    const double dimmed = sumOf(test::render(scene).image.layers.at("cloud.G"));
    EXPECT_NEAR(dimmed / clear, std::exp(-1.0), 0.01);
    layer = {.absorption = glm::dvec3(0.01), .bottom = 5e4, .top = 5e4 + 100.0};
    const double below = sumOf(test::render(scene).image.layers.at("cloud.G"));
    EXPECT_NEAR(below / clear, std::exp(-1.0), 1e-4);
}

TEST(RendererFog, EndlessFogAroundCloudsIsRefused) {
    scene::Scene scene = foggy(1e-4, 0.0);
    scene.fog.media[0].top = std::numeric_limits<double>::infinity();
    EXPECT_THROW(Renderer(scene, {.device = "", .validation = true}), InputError);
}

}  // namespace
}  // namespace lumulus
