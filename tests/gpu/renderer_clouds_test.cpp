// Several clouds in one picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;
using test::smallScene;
using testing::Contains;
using testing::Not;

/// A ball like that of the small scene, elsewhere.
scene::Cloud ballAt(const dvec3& offset) {
    scene::Cloud cloud = smallScene().clouds[0];
    cloud.transform[3] = glm::dvec4(offset, 1.0);
    return cloud;
}

double meanOf(const LayeredImage& image, const char* layer) {
    double sum = 0.0;
    for (const float value : image.layers.at(layer)) sum += static_cast<double>(value);
    return sum / static_cast<double>(image.pixels());
}

/// The largest difference of a layer.
double difference(const Frame& a, const Frame& b, const char* layer) {
    const auto &left = a.image.layers.at(layer), &right = b.image.layers.at(layer);
    double largest = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i)
        largest = std::max(largest, std::abs(static_cast<double>(left[i]) - static_cast<double>(right[i])));
    return largest;
}

class Clouds : public testing::TestWithParam<scene::DrawMode> {
  protected:
    scene::Scene scene = smallScene();

    void SetUp() override {
        scene.draw.mode = GetParam();
        scene.draw.tolerance = 0.0;
        scene.image = {96, 48, 0.0};  // one ray a pixel: means of products are products
        scene.camera.position = dvec3(0.0, 100.0, 700.0);
        scene.camera.target = dvec3(0.0, 100.0, 0.0);
        scene.camera.verticalFov = 30.0;
    }
    Frame with(std::vector<scene::Cloud> clouds) {
        scene.clouds = std::move(clouds);
        return test::render(scene);
    }
};
INSTANTIATE_TEST_SUITE_P(Modes, Clouds, testing::Values(scene::DrawMode::march, scene::DrawMode::billboards),
                         [](const auto& mode) {
                             return mode.param == scene::DrawMode::march ? "march" : "billboards";
                         });

/// Black clouds, side by side and one behind the other: what is seen through both is the product.
TEST_P(Clouds, TransmittancesMultiply) {
    scene::Cloud left = ballAt({-120, 0, 0}), behind = ballAt({-60, 10, -300});
    left.albedo = behind.albedo = dvec3(0.0);
    const Frame one = with({left}), other = with({behind}), both = with({left, behind});
    double largest = 0.0, least = 1.0, product = 0.0;
    for (std::size_t i = 0; i < both.image.pixels(); ++i) {
        const auto t = [&](const Frame& frame) {
            return static_cast<double>(frame.image.layers.at("transmittance.G")[i]);
        };
        largest = std::max(largest, std::abs(t(both) - t(one) * t(other)));
        least = std::min(least, t(one) * t(other));
        product += t(one) * t(other) / static_cast<double>(both.image.pixels());
    }
    EXPECT_LT(least, 0.05) << "they hide each other somewhere";
    EXPECT_LT(largest, 1e-2) << "steps of other lengths where both are met";
    EXPECT_NEAR(meanOf(both.image, "transmittance.G"), product, 2e-4);
}

/// Half the density twice at one place is the whole once.
TEST_P(Clouds, ExtinctionsAddUp) {
    scene::Cloud whole = ballAt(dvec3(0.0)), half = whole;
    whole.albedo = half.albedo = dvec3(0.0);
    half.extinction *= 0.5;
    const Frame once = with({whole}), twice = with({half, half});
    // Rays in several clouds take other steps, and each step of the ball's edge is wrong by up to half of its optical
    // thickness of 0.12 without a sign; the mean over 4,608 rays is right to a fiftieth of that.
    EXPECT_LT(difference(once, twice, "transmittance.G"), 2e-2);
    EXPECT_NEAR(meanOf(twice.image, "transmittance.G"), meanOf(once.image, "transmittance.G"), 2e-4);
}

/// Lit by the sun alone, whose first scattering needs no photon, each cloud looks as it does by itself where the other
/// is not seen.
TEST_P(Clouds, EachIsLitAsByItself) {
    scene.sky.radiance = dvec3(0.0);
    scene.photonMap.photons = 400000;
    const scene::Cloud left = ballAt({-260, 0, 0}), right = ballAt({260, 0, 0});
    const Frame one = with({left}), other = with({right}), both = with({left, right});
    const double alone = meanOf(one.image, "cloud.G") + meanOf(other.image, "cloud.G");
    EXPECT_GT(alone, 0.01);
    // photons are shared out: multiply scattered light has its noise
    EXPECT_NEAR(meanOf(both.image, "cloud.G"), alone, 0.02 * alone);
}

TEST_P(Clouds, TheOrderInTheSceneDoesNotMatter) {
    scene::Cloud near = ballAt({-60, 0, 0}), far = ballAt({60, 30, -300});
    near.albedo = {0.9, 0.9, 0.9};
    far.phase.g = 0.5;
    scene.sky.radiance = dvec3(0.0);
    const Frame a = with({near, far}), b = with({far, near});
    EXPECT_LT(difference(a, b, "transmittance.G"), 1e-5);
    EXPECT_LT(difference(a, b, "depth.front"), 1e-2);
}

/// In a uniform sky clouds that do not absorb are not seen, and what they hide of each other neither.
TEST_P(Clouds, AreNotSeenInAUniformSky) {
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(1.0);
    scene.photonMap.photons = 60000;
    scene.preparation.samples = 2000;
    scene.preparation.maxLeaves = 600;
    const Frame both = with({ballAt({-130, 0, 0}), ballAt({130, 0, 0})});
    EXPECT_NEAR(meanOf(both.image, "G"), 1.0, 0.01);
}

TEST_P(Clouds, OneOfTwoThatIsNothingLeavesTheBitsOfTheOther) {
    scene::Cloud nothing = ballAt({130, 0, 0});
    nothing.densityScale = 0.0;
    const Frame one = with({ballAt({-130, 0, 0})}), both = with({ballAt({-130, 0, 0}), nothing});
    EXPECT_EQ(one.image.layers, both.image.layers);
    EXPECT_EQ(one.passes(), both.passes());
}

TEST_P(Clouds, SameSourceAndShapeShareAnAsset) {
    const Frame one = with({ballAt(dvec3(0.0))}), two = with({ballAt({-130, 0, 0}), ballAt({130, 0, 0})});
    EXPECT_EQ(one.statistics.collectors, two.statistics.collectors);
    EXPECT_THAT(one.passes(), Not(Contains("atlas")));
    EXPECT_THAT(two.passes(), Contains("atlas"));
}

TEST(CloudChanges, OneCloudIsChangedByItsName) {
    scene::Scene scene = smallScene();
    scene.clouds = {ballAt({-130, 0, 0}), ballAt({130, 0, 0})};
    scene.clouds[1].name = "right";
    Renderer renderer(scene, {.device = "", .validation = true, .keepRing = true});
    EXPECT_THAT(renderer.clouds(), testing::ElementsAre("0", "right"));
    EXPECT_TRUE(renderer.setExtinction(0.02, renderer.findCloud("right")));
    EXPECT_EQ(renderer.extinction(0), 0.01);
    EXPECT_EQ(renderer.extinction(1), 0.02);
    EXPECT_TRUE(renderer.setExtinction(0.03));
    EXPECT_EQ(renderer.extinction(0), 0.03);
    EXPECT_EQ(renderer.extinction(1), 0.03);
    EXPECT_THROW(renderer.findCloud("left"), std::exception);
    EXPECT_FALSE(renderer.setExtinction(0.03));
}

/// A cloud that has moved looks like one that was made there.
TEST(CloudChanges, OneCloudMoves) {
    scene::Scene scene = smallScene();
    scene.sky.radiance = dvec3(0.0);
    scene.camera.position = dvec3(0.0, 100.0, 700.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.clouds = {ballAt({-130, 0, 0}), ballAt({130, 0, 0})};
    Renderer moved(scene, {.device = "", .validation = true, .keepRing = true});
    moved.setOffset({0.0, 40.0, 0.0}, 1);
    const Frame there{moved.draw(), moved.statistics()};
    scene.clouds[1] = ballAt({130, 40, 0});
    Renderer made(scene, {.device = "", .validation = true, .keepRing = true});
    const Frame here{made.draw(), made.statistics()};
    EXPECT_LT(difference(there, here, "transmittance.G"), 1e-4);
}

}  // namespace
}  // namespace lumulus
