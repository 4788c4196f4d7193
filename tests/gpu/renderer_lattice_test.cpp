// Pixels between lattice points: interpolated where that is the same picture, drawn where it is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;

/// A ball of 40 voxels across, each of about five pixels.
scene::Scene closeScene(scene::DrawMode mode) {
    scene::Scene scene = test::smallScene();
    scene.image = {200, 150, 0.0};
    scene.clouds[0].resolution = 40;
    scene.clouds[0].extinction = 0.05;
    scene.preparation.samples = 3000;
    scene.preparation.maxLeaves = 1000;
    scene.photonMap.photons = 40000;
    scene.draw.mode = mode;
    return scene;
}

Frame drawn(scene::Scene scene, double tolerance) {
    scene.draw.tolerance = tolerance;
    return test::render(scene);
}

double value(const LayeredImage& image, const std::string& layer, std::size_t i) {
    return static_cast<double>(image.layers.at(layer)[i]);
}

struct Difference {
    double rms = 0.0, most = 0.0;  ///< against the rms of the second picture
};

Difference difference(const LayeredImage& a, const LayeredImage& b, const std::string& layer) {
    Difference found;
    double norm = 0.0;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        const double d = value(a, layer, i) - value(b, layer, i);
        found.rms += d * d;
        found.most = std::max(found.most, std::abs(d));
        norm += std::pow(value(b, layer, i), 2);
    }
    const double scale = std::sqrt(norm / static_cast<double>(a.pixels()));
    return {std::sqrt(found.rms / norm), found.most / scale};
}

class Lattice : public testing::TestWithParam<scene::DrawMode> {};
INSTANTIATE_TEST_SUITE_P(Modes, Lattice, testing::Values(scene::DrawMode::march, scene::DrawMode::billboards),
                         [](const auto& mode) {
                             return mode.param == scene::DrawMode::march ? "march" : "billboards";
                         });

TEST_P(Lattice, InterpolatedIsTheSamePicture) {
    const scene::Scene scene = closeScene(GetParam());
    const LayeredImage every = drawn(scene, 0.0).image, some = drawn(scene, 0.2).image;
    for (const char* layer : {"R", "cloud.G", "transmittance.B", "A"}) {
        const Difference found = difference(some, every, layer);
        EXPECT_GT(found.rms, 0.0) << layer;  // something was interpolated
        EXPECT_LT(found.rms, 0.01) << layer;
        EXPECT_LT(found.most, 0.1) << layer;
    }
    const double voxel = 200.0 / 40.0;
    for (std::size_t i = 0; i < every.pixels(); ++i) {
        ASSERT_EQ(value(some, "depth.front", i) >= 1e10, value(every, "depth.front", i) >= 1e10);
        ASSERT_NEAR(value(some, "depth.Z", i), value(every, "depth.Z", i), 8.0 * voxel);
    }
}

/// A quarter of what bends is the most that an interpolation can be wrong by, so less of it makes less error.
TEST_P(Lattice, LessToleranceIsLessError) {
    const scene::Scene scene = closeScene(GetParam());
    const LayeredImage every = drawn(scene, 0.0).image;
    const double wide = difference(drawn(scene, 0.4).image, every, "cloud.R").rms;
    const double narrow = difference(drawn(scene, 0.02).image, every, "cloud.R").rms;
    EXPECT_LT(narrow, 0.5 * wide);
}

TEST_P(Lattice, TheSunsDiscIsNotSpread) {
    scene::Scene scene = closeScene(GetParam());
    scene.clouds[0].extinction = 0.005;
    scene.camera.position = dvec3(0.0, 100.0, 600.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.sun.directionTo = dvec3(0.08, 0.05, -1.0) / glm::length(dvec3(0.08, 0.05, -1.0));
    scene.sun.angularDiameter = 1.0;
    const LayeredImage every = drawn(scene, 0.0).image, some = drawn(scene, 0.4).image;
    std::size_t bright = 0;
    for (std::size_t i = 0; i < every.pixels(); ++i) {
        const double truth = value(every, "R", i);
        ASSERT_NEAR(value(some, "R", i), truth, 0.05 * truth + 1e-3) << i;
        bright += truth > 1000.0 ? 1 : 0;
    }
    EXPECT_GT(bright, 10U);
}

TEST(LatticePasses, AreThereOnlyWhereVoxelsAreLarger) {
    scene::Scene scene = closeScene(scene::DrawMode::march);
    EXPECT_THAT(drawn(scene, 0.2).passes(), testing::Contains("interpolate"));
    EXPECT_THAT(drawn(scene, 0.0).passes(), testing::Not(testing::Contains("interpolate")));
    scene.image = {20, 15, 0.0};
    EXPECT_THAT(drawn(scene, 0.2).passes(), testing::Not(testing::Contains("interpolate")));
}

}  // namespace
}  // namespace lumulus
