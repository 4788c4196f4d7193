// Pixels between sampling points: interpolated where that is the same picture, drawn where it is not.
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

/// Of a layer, against the rms of the second picture.
double difference(const LayeredImage& a, const LayeredImage& b, const std::string& layer) {
    double squares = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        squares += std::pow(value(a, layer, i) - value(b, layer, i), 2);
        norm += std::pow(value(b, layer, i), 2);
    }
    return std::sqrt(squares / norm);
}

/// The largest value at most two sampling points away, which the tolerance refers to.
double brightest(const LayeredImage& image, const std::string& layer, int x, int y) {
    double most = 0.0;
    for (int v = std::max(y - 8, 0); v <= std::min(y + 8, image.height - 1); ++v)
        for (int u = std::max(x - 8, 0); u <= std::min(x + 8, image.width - 1); ++u)
            most = std::max(most, value(image, layer, static_cast<std::size_t>(v * image.width + u)));
    return most;
}

/// An eighth of a second difference is the error where the picture is smooth, a half of it at a kink. Of light it is
/// allowed a part of the brightest, of transmittance half that part of 1.
void expectWithinTolerance(const LayeredImage& some, const LayeredImage& every, double tolerance) {
    for (int y = 0; y < every.height; ++y)
        for (int x = 0; x < every.width; ++x) {
            const auto i = static_cast<std::size_t>(y * every.width + x);
            ASSERT_NEAR(value(some, "cloud.G", i), value(every, "cloud.G", i),
                        0.5 * tolerance * brightest(every, "cloud.G", x, y))
                << x << " " << y;
            for (const char* layer : {"transmittance.B", "cloud.A"})
                ASSERT_NEAR(value(some, layer, i), value(every, layer, i), 0.25 * tolerance)
                    << layer << " " << x << " " << y;
        }
}

class SparseSampling : public testing::TestWithParam<scene::DrawMode> {};
INSTANTIATE_TEST_SUITE_P(Modes, SparseSampling, testing::Values(scene::DrawMode::march, scene::DrawMode::billboards),
                         [](const auto& mode) {
                             return mode.param == scene::DrawMode::march ? "march" : "billboards";
                         });

TEST_P(SparseSampling, InterpolatedIsTheSamePicture) {
    const scene::Scene scene = closeScene(GetParam());
    const LayeredImage every = drawn(scene, 0.0).image, some = drawn(scene, 0.2).image;
    for (const char* layer : {"R", "cloud.G", "transmittance.B", "cloud.A"}) {
        const double found = difference(some, every, layer);
        EXPECT_GT(found, 0.0) << layer;  // something was interpolated
        EXPECT_LT(found, 0.01) << layer;
    }
    expectWithinTolerance(some, every, 0.2);
    const double voxel = 200.0 / 40.0;
    for (std::size_t i = 0; i < every.pixels(); ++i) {
        ASSERT_EQ(value(some, "depth.front", i) >= 1e10, value(every, "depth.front", i) >= 1e10);
        ASSERT_NEAR(value(some, "depth.Z", i), value(every, "depth.Z", i), 8.0 * voxel);
    }
}

TEST_P(SparseSampling, LessToleranceIsLessError) {
    const scene::Scene scene = closeScene(GetParam());
    const LayeredImage every = drawn(scene, 0.0).image;
    const double wide = difference(drawn(scene, 0.4).image, every, "cloud.R");
    const double narrow = difference(drawn(scene, 0.02).image, every, "cloud.R");
    EXPECT_LT(narrow, 0.5 * wide);
}

TEST_P(SparseSampling, TheSunsDiscIsNotSpread) {
    scene::Scene scene = closeScene(GetParam());
    scene.clouds[0].extinction = 0.005;
    scene.camera.position = dvec3(0.0, 100.0, 600.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.sun.directionTo = dvec3(0.08, 0.05, -1.0) / glm::length(dvec3(0.08, 0.05, -1.0));
    scene.sun.angularDiameter = 1.0;
    const LayeredImage every = drawn(scene, 0.0).image, some = drawn(scene, 0.4).image;
    // the disc shines through by the pixel's transmittance, which interpolation changes by less than the tolerance
    constexpr double tolerance = 0.4;
    std::size_t bright = 0;
    for (std::size_t i = 0; i < every.pixels(); ++i) {
        const bool sees = value(every, "R", i) >= 1000.0;
        ASSERT_EQ(value(some, "R", i) >= 1000.0, sees) << i;
        if (!sees) continue;
        ASSERT_NEAR(value(some, "R", i), value(every, "R", i), 0.1 * tolerance * value(every, "R", i)) << i;
        ++bright;
    }
    EXPECT_GE(bright, 5U);
    expectWithinTolerance(some, every, 0.4);
}

/// Rays along an axis of the grid never meet the faces beside them.
TEST(MarchAlongAnAxis, SeesTheCloud) {
    scene::Scene scene = closeScene(scene::DrawMode::march);
    scene.camera.projection = scene::Projection::orthographic;
    scene.clouds[0].extinction = 0.005;
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    for (const dvec3& from : {dvec3(0.0, 0.0, 1000.0), dvec3(-1000.0, 0.0, 0.0), dvec3(0.0, 1000.0, 0.0)}) {
        const auto middle = [&](const dvec3& aside) {
            scene.camera.position = *scene.camera.target + from + aside;
            return value(drawn(scene, 0.2).image, "transmittance.R", 75 * 200 + 100);
        };
        EXPECT_LT(middle(dvec3(0.0)), 0.6);  // about e⁻¹
        EXPECT_NEAR(middle(dvec3(0.0)), middle(dvec3(0.7, 0.3, 0.5)), 0.01);
    }
}

TEST(SparseSamplingPasses, AreThereOnlyWhereVoxelsAreLarger) {
    scene::Scene scene = closeScene(scene::DrawMode::march);
    EXPECT_THAT(drawn(scene, 0.2).passes(), testing::Contains("interpolate"));
    EXPECT_THAT(drawn(scene, 0.0).passes(), testing::Not(testing::Contains("interpolate")));
    scene.image = {20, 15, 0.0};
    EXPECT_THAT(drawn(scene, 0.2).passes(), testing::Not(testing::Contains("interpolate")));
}

/// The ball, and small ones far away: beside it and, seen past its rim, behind it.
scene::Scene nearAndFar(scene::DrawMode mode) {
    scene::Scene scene = closeScene(mode);
    scene.clouds[0].resolution = 16;  // voxels of about five pixels
    scene.camera.position = dvec3(0.0, 100.0, 500.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.camera.verticalFov = 36.0;
    for (const double across : {1750.0, -950.0}) {
        scene.clouds.push_back(scene.clouds[0]);
        scene.clouds.back().transform[3] = glm::dvec4(across, 0.0, -4500.0, 1.0);
    }
    return scene;
}

/// Of several clouds each tile is drawn as finely as the smallest voxels in it ask for.
TEST_P(SparseSampling, OfSeveralCloudsIsAsFineAsEachNeeds) {
    const scene::Scene scene = nearAndFar(GetParam());
    const Frame every = drawn(scene, 0.0), some = drawn(scene, 0.2);
    EXPECT_THAT(some.passes(), testing::Contains("interpolate"));
    for (const char* layer : {"R", "cloud.G", "transmittance.B", "cloud.A"}) {
        const double found = difference(some.image, every.image, layer);
        EXPECT_GT(found, 0.0) << layer;
        EXPECT_LT(found, 0.01) << layer;
    }
    // billboards of so few voxels bend more sharply, those of the ball alone too
    if (GetParam() == scene::DrawMode::march) expectWithinTolerance(some.image, every.image, 0.2);
    const glm::ivec2 middle(100 + static_cast<int>(1750.0 / 5000.0 * 75.0 / std::tan(18.0 * 3.14159265 / 180.0)), 75);
    std::size_t cloudy = 0;
    for (int y = middle.y - 5; y <= middle.y + 5; ++y)
        for (int x = middle.x - 5; x <= middle.x + 5; ++x) {
            const auto i = static_cast<std::size_t>(y * 200 + x);
            if (value(every.image, "cloud.A", i) > 0.0) ++cloudy;
            ASSERT_EQ(value(some.image, "cloud.G", i), value(every.image, "cloud.G", i)) << x << " " << y;
        }
    EXPECT_GT(cloudy, 30U);
}

/// Voxels below a pixel need several rays, in the tiles where they are seen and not in all of the picture: the near
/// ball looks as it does alone.
TEST(RaysOfPixels, AreThoseOfTheTile) {
    scene::Scene scene = nearAndFar(scene::DrawMode::march);
    scene.preparation.levelOfDetail = false;
    const LayeredImage both = drawn(scene, 0.0).image;
    scene.clouds.resize(1);
    const LayeredImage alone = drawn(scene, 0.0).image;
    std::size_t compared = 0;
    for (int y = 0; y < alone.height; ++y)
        for (int x = 0; x < 40; ++x) {  // left of the far ones
            const auto i = static_cast<std::size_t>(y * alone.width + x);
            for (const char* layer : {"transmittance.R", "cloud.A"})
                ASSERT_NEAR(value(both, layer, i), value(alone, layer, i), 1e-5) << layer << " " << x << " " << y;
            if (value(alone, "cloud.A", i) > 0.0) ++compared;
        }
    for (int y = 0; y < alone.height; ++y)  // and above them
        for (int x = 90; x < 110; ++x) {
            const auto i = static_cast<std::size_t>(y * alone.width + x);
            ASSERT_NEAR(value(both, "transmittance.R", i), value(alone, "transmittance.R", i), 1e-5) << x << " " << y;
            if (value(alone, "cloud.A", i) > 0.0) ++compared;
        }
    EXPECT_GT(compared, 1000U);
}

TEST(SparseSamplingPasses, AreLeftOutWhereAllCloudsAreFar) {
    scene::Scene scene = nearAndFar(scene::DrawMode::march);
    scene.clouds.erase(scene.clouds.begin());
    EXPECT_THAT(drawn(scene, 0.2).passes(), testing::Not(testing::Contains("interpolate")));
}

}  // namespace
}  // namespace lumulus
