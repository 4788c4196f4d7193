// What a scene does not need is not recorded, and what is recorded is clean under validation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/renderer.h"
#include "support/small_scene.h"
#include "support/temporary_folder.h"
#include "support/test_volumes.h"
#include "vdb/write.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;
using test::smallScene;
using testing::Contains;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

void expectFinite(const LayeredImage& image) {
    EXPECT_GE(image.layers.size(), 11U);
    for (const auto& [name, values] : image.layers)
        for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
}

std::string drawPass(scene::DrawMode mode) {
    return mode == scene::DrawMode::march ? "march" : "billboards";
}

class EachMode : public testing::TestWithParam<scene::DrawMode> {
  protected:
    scene::Scene scene = smallScene();
    void SetUp() override { scene.draw.mode = GetParam(); }

    /// No pass but the drawing, no photon, and nothing in the layer.
    void expectOnlyDrawn(const std::string& blackLayer) const {
        const Frame frame = test::render(scene);
        EXPECT_THAT(frame.passes(), ElementsAre(drawPass(GetParam())));
        EXPECT_EQ(frame.statistics.photons, 0U);
        EXPECT_THAT(frame.image.layers.at(blackLayer), testing::Each(0.0F));
        expectFinite(frame.image);
    }
};
INSTANTIATE_TEST_SUITE_P(Passes, EachMode, testing::Values(scene::DrawMode::march, scene::DrawMode::billboards),
                         [](const auto& mode) { return drawPass(mode.param); });

TEST_P(EachMode, SunAndSky) {
    const Frame frame = test::render(scene);
    // no "accumulate": without a ring the light is read where it was traced
    const std::vector<std::string> expected{"trace",       "sort",         "gather",      "shadow volume",
                                            "reconstruct", "light counts", "light field", drawPass(GetParam())};
    EXPECT_THAT(frame.passes(), ElementsAreArray(expected));
    EXPECT_EQ(frame.statistics.photons, 4000U);
    EXPECT_EQ(frame.statistics.generations, 2U);
    EXPECT_GT(frame.statistics.events, 0U);
    EXPECT_EQ(frame.statistics.escaped, 4000U);
    EXPECT_EQ(frame.statistics.lost + frame.statistics.absorbed + frame.statistics.saturated, 0U);
    expectFinite(frame.image);
}

TEST_P(EachMode, DarkSunHasNoPassesOfItsOwn) {
    scene.sun.irradiance = dvec3(0.0);
    const Frame frame = test::render(scene);
    EXPECT_THAT(frame.passes(), Not(Contains("shadow volume")));
    EXPECT_THAT(frame.passes(), Contains("trace"));
    expectFinite(frame.image);
}

TEST_P(EachMode, WithoutLightThereIsOnlyTheDrawing) {
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.0);
    expectOnlyDrawn("R");
}

TEST_P(EachMode, BlackCloudIsOnlyDrawn) {
    scene.clouds[0].albedo = dvec3(0.0);
    expectOnlyDrawn("cloud.R");
}

/// A black sky: all photons are the sun's; without scattering twice, none is stored.
TEST_P(EachMode, SunOnly) {
    scene.sky.radiance = dvec3(0.0);
    const Frame frame = test::render(scene);
    EXPECT_THAT(frame.passes(), Contains("shadow volume"));
    EXPECT_EQ(frame.statistics.photons, 4000U);
    expectFinite(frame.image);
}

TEST_P(EachMode, ForwardCutAndColour) {
    scene.photonMap.forwardCut = 12.0;
    scene.clouds[0].albedo = {1.0, 0.8, 0.0};
    expectFinite(test::render(scene).image);
}

TEST_P(EachMode, DropletsFromAnOrthographicCamera) {
    scene.clouds[0].phase.model = scene::PhaseModel::droplet;
    scene.camera.projection = scene::Projection::orthographic;
    expectFinite(test::render(scene).image);
}

TEST_P(EachMode, DropletsCutInAPanoramaFromWithin) {
    scene.clouds[0].phase.model = scene::PhaseModel::droplet;
    scene.photonMap.forwardCut = 12.0;
    scene.photonMap.majorant = scene::Majorant::local;
    scene.camera.projection = scene::Projection::panorama;
    scene.camera.position = dvec3(10.0, 90.0, 20.0);
    scene.camera.target = dvec3(0.0, 100.0, -50.0);
    const Frame frame = test::render(scene);
    expectFinite(frame.image);
    for (const float front : frame.image.layers.at("depth.front")) ASSERT_EQ(front, 0.0F) << "cloud on every side";
}

TEST_P(EachMode, TheSunsDepthsAreMadeOnce) {
    Renderer renderer(scene, {.device = "", .validation = true});
    renderer.traceGeneration();
    renderer.draw();
    renderer.traceGeneration();
    renderer.draw();
    std::vector<std::string> names;
    for (const PassTime& pass : renderer.statistics().passes) names.push_back(pass.name);
    EXPECT_THAT(names, Not(Contains("shadow volume")));
    EXPECT_THAT(names, Contains(drawPass(GetParam())));
    EXPECT_THAT(renderer.statistics().validationMessages, IsEmpty());
}

/// An orthographic picture of several bands of rows, none of which is a whole tile at the end.
TEST_P(EachMode, BandsOfRows) {
    scene.clouds[0].albedo = dvec3(0.0);
    scene.image = {3000, 500, 0.0};
    scene.preparation.samples = 4000;  // enough leaves for billboards to be as round as the ball
    scene.preparation.maxLeaves = 4000;
    const Frame frame = test::render(scene);
    expectFinite(frame.image);
    const auto& alpha = frame.image.layers.at("cloud.A");
    // the ball is as high above the middle as below it
    double upper = 0.0, lower = 0.0;
    for (std::size_t i = 0; i < alpha.size(); ++i)
        (i < alpha.size() / 2 ? upper : lower) += static_cast<double>(alpha[i]);
    EXPECT_NEAR(upper, lower, 0.05 * upper);
}

TEST(Leaves, TooFewAreToldOf) {
    scene::Scene scene = smallScene();
    const auto warnings = [&](int most) {
        scene.preparation.maxLeaves = most;
        return test::render(scene).statistics.warnings;
    };
    EXPECT_THAT(warnings(8), Contains(HasSubstr("preparation.max_leaves")));
    EXPECT_THAT(warnings(20000), IsEmpty());
}

class EachBandCount : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Bands, EachBandCount, testing::Range(1, 9));

TEST_P(EachBandCount, Renders) {
    scene::Scene scene = smallScene();
    scene.photonMap.bands = GetParam();
    const Frame frame = test::render(scene);
    expectFinite(frame.image);
    EXPECT_GT(*std::max_element(frame.image.layers.at("cloud.G").begin(), frame.image.layers.at("cloud.G").end()),
              0.0F);
}

TEST(EmptyScene, RecordsNothing) {
    scene::Scene scene = smallScene();
    scene.clouds.clear();
    const Frame frame = test::render(scene);
    EXPECT_THAT(frame.passes(), IsEmpty());
    EXPECT_EQ(frame.statistics.photons, 0U);
    EXPECT_THAT(frame.image.layers.at("cloud.A"), testing::Each(0.0F));
    expectFinite(frame.image);
}

TEST(EmptyScene, VolumeOfZerosRecordsNothing) {
    const test::TemporaryFolder folder;
    vdb::write(test::emptyVolume({10, 10, 10}), folder / "zero.vdb");
    scene::Scene scene = smallScene();
    scene.clouds[0].vdb = folder / "zero.vdb";
    const Frame frame = test::render(scene);
    EXPECT_THAT(frame.passes(), IsEmpty());
    EXPECT_THAT(frame.statistics.warnings, Not(IsEmpty()));
    EXPECT_THAT(frame.image.layers.at("cloud.A"), testing::Each(0.0F));
    expectFinite(frame.image);
}

TEST(EmptyScene, NoExtinctionRecordsNothing) {
    scene::Scene scene = smallScene();
    scene.clouds[0].densityScale = 0.0;
    const Frame frame = test::render(scene);
    EXPECT_THAT(frame.passes(), IsEmpty());
    EXPECT_THAT(frame.image.layers.at("cloud.A"), testing::Each(0.0F));
}

}  // namespace
}  // namespace lumulus
