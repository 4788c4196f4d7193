// A scene with another density that goes on with the light of the one before, as the service swaps them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "render/frame_light.h"
#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;

RendererOptions withRing() {
    RendererOptions options;
    options.keepRing = true;
    return options;
}

scene::Scene before() {
    scene::Scene scene = test::smallScene();
    scene.image = {48, 36, 0.0};
    scene.photonMap.photons = 80000;
    scene.photonMap.generations = 4;
    scene.clouds[0].procedural = "cumulus";
    scene.clouds[0].resolution = 32;
    return scene;
}

/// The same cloud in other voxels.
scene::Scene after() {
    scene::Scene scene = before();
    scene.clouds[0].resolution = 37;
    return scene;
}

std::vector<photon::Way> still(const scene::Scene& scene) {
    return std::vector<photon::Way>(scene.clouds.size(), [](const dvec3&) { return dvec3(0.0); });
}

void trace(Renderer& renderer, int generations) {
    for (int i = 0; i < generations; ++i) renderer.traceGeneration();
}

bool goOn(Renderer& now, const scene::Scene& scene, Renderer& then, const scene::Scene& of) {
    return now.goOnFrom(scene, *then.frameLight(of), still(scene));
}

/// relMSE of the cloud's green light, against that of a picture.
double differenceOf(const LayeredImage& image, const LayeredImage& truth) {
    const std::vector<float>&a = image.layers.at("cloud.G"), &b = truth.layers.at("cloud.G");
    double mean = 0.0, sum = 0.0;
    for (const float value : b) mean += static_cast<double>(value) / static_cast<double>(b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto is = static_cast<double>(a[i]), should = static_cast<double>(b[i]);
        sum += (is - should) * (is - should) / (should * should + 0.01 * mean * mean);
    }
    return sum / static_cast<double>(a.size());
}

TEST(RendererSwapped, TheSameDensityHasTheSameBits) {
    for (const double extinction : {1.0, 3.0}) {
        const scene::Scene scene = before();
        Renderer first(scene, withRing());
        trace(first, 3);
        first.setExtinction(extinction * scene.clouds[0].extinction);
        trace(first, 3);  // more than the ring holds
        Renderer second(scene, withRing());
        second.take(first.changes());
        ASSERT_TRUE(goOn(second, scene, first, scene));
        EXPECT_EQ(second.generations().count, 4);
        EXPECT_EQ(second.generations().first, first.generations().first);
        EXPECT_EQ(second.generations().current, 0);
        // the ring has an extinction of its own for each generation, which only its mean is left of
        if (extinction == 1.0)
            EXPECT_EQ(second.draw().layers, first.draw().layers);
        else
            EXPECT_LT(differenceOf(second.draw(), first.draw()), 1e-4);
        trace(first, 4);
        trace(second, 4);
        EXPECT_EQ(second.generations().current, 4);
        EXPECT_EQ(second.draw().layers, first.draw().layers) << "the light of before is gone, to the last count";
    }
}

TEST(RendererSwapped, AnotherDensityBeginsWithTheLightOfBefore) {
    scene::Scene scene = after();
    scene.photonMap.photons *= 16;
    scene.photonMap.generations *= 16;
    Renderer much(scene, withRing());
    trace(much, scene.photonMap.generations);
    const LayeredImage truth = much.draw();

    Renderer first(before(), withRing()), second(after(), withRing()), anew(after(), withRing());
    trace(first, 4);
    ASSERT_TRUE(goOn(second, after(), first, before()));
    trace(anew, 1);
    const double carried = differenceOf(second.draw(), truth), one = differenceOf(anew.draw(), truth);
    EXPECT_LT(carried, 0.6 * one) << "a generation has a quarter of the photons, and four times the noise";
    // what was traced gives way: in the end it is the scene loaded anew, whose generations have these numbers
    trace(second, 4);
    scene::Scene later = after();
    later.photonMap.firstGeneration = 4;
    Renderer last(later, withRing());
    trace(last, 4);
    EXPECT_EQ(second.draw().layers, last.draw().layers);
}

/// The unit of the counts follows the size of the clouds.
TEST(RendererSwapped, ACloudMayGrowByMuch) {
    scene::Scene small = before(), large = before();
    for (int axis = 0; axis < 3; ++axis) large.clouds[0].transform[axis][axis] = 4096.0;
    large.clouds[0].extinction /= 4096.0;
    Renderer first(small, withRing()), second(large, withRing());
    trace(first, 4);
    ASSERT_TRUE(goOn(second, large, first, small));  // in the cloud's own coordinates it has not changed
    trace(second, 4);
    scene::Scene later = large;
    later.photonMap.firstGeneration = 4;
    Renderer last(later, withRing());
    trace(last, 4);
    EXPECT_EQ(last.statistics().saturated, 0U);
    EXPECT_EQ(second.statistics().saturated, 0U);
    EXPECT_LT(differenceOf(second.draw(), last.draw()), 1e-9) << "but for the rounding of other units";
}

/// A cloud that had no light before gets it from the new generations alone, and the others keep theirs.
TEST(RendererSwapped, OneOfTwoComes) {
    scene::Scene both = test::smallScene();
    both.image = {64, 24, 0.0};
    both.camera.position = dvec3(0.0, 100.0, 900.0);
    both.camera.target = dvec3(0.0, 100.0, 0.0);
    both.camera.verticalFov = 20.0;
    both.photonMap.photons = 40000;
    both.photonMap.generations = 4;
    both.clouds.push_back(both.clouds[0]);
    both.clouds[0].transform[3].x = -200.0;
    both.clouds[1].transform[3].x = 200.0;
    scene::Scene one = both;
    one.clouds[1].extinction = 0.0;
    const auto halfOf = [](const LayeredImage& image, int half) {
        double sum = 0.0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width / 2; ++x)
                sum += static_cast<double>(
                    image.layers.at("cloud.G")[static_cast<std::size_t>(y * image.width + x + half * image.width / 2)]);
        return sum;
    };
    Renderer first(both, withRing()), second(one, withRing()), third(both, withRing());
    trace(first, 4);
    const LayeredImage truth = first.draw();
    EXPECT_TRUE(goOn(second, one, first, both)) << "the map of one cloud has the light of one of two";
    EXPECT_NEAR(halfOf(second.draw(), 0), halfOf(truth, 0), 0.05 * halfOf(truth, 0));
    trace(second, 4);
    ASSERT_TRUE(goOn(third, both, second, one));
    EXPECT_NEAR(halfOf(third.draw(), 0), halfOf(truth, 0), 0.05 * halfOf(truth, 0));
    third.traceGeneration();
    EXPECT_NEAR(halfOf(third.draw(), 1), halfOf(truth, 1), 0.1 * halfOf(truth, 1)) << "the mean of one, not of five";
}

}  // namespace
}  // namespace lumulus
