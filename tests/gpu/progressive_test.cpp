// Pictures whose photons are not counted beforehand: what is said of their noise is true, and they are the same bits as
// pictures that were told how many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "progressive/noise.h"
#include "progressive/trace_until.h"
#include "support/small_scene.h"

namespace lumulus::progressive {
namespace {

using test::smallScene;

/// A clock that nobody looks at.
double noTime() {
    return 0.0;
}

RendererOptions progressiveOptions(bool validation = false) {
    return {.device = "", .validation = validation, .progressive = true};
}

struct Progressive {
    LayeredImage image;
    double noise = 0.0;
};

Progressive pictureOf(const scene::Scene& scene, int generations) {
    Renderer renderer(scene, progressiveOptions());
    for (int i = 0; i < generations; ++i) renderer.traceGeneration();
    Progressive result;
    result.noise = noiseOf(renderer.preview(), generations);
    result.image = renderer.draw();
    return result;
}

/// Pictures of many seeds differ from each other as much as each says of itself.
TEST(Progressive, NoiseIsThatBetweenSeeds) {
    constexpr int seeds = 24, generations = 4;
    scene::Scene scene = smallScene();
    std::vector<Progressive> pictures;
    for (int seed = 1; seed <= seeds; ++seed) {
        scene.photonMap.seed = static_cast<std::uint64_t>(seed);
        pictures.push_back(pictureOf(scene, generations));
    }
    std::vector<double> means, variances;  // of each pixel and channel
    double mean = 0.0;
    for (const char* colour : {"R", "G", "B"})
        for (std::size_t i = 0; i < pictures[0].image.pixels(); ++i) {
            if (!(pictures[0].image.layers.at("transmittance.R")[i] < 0.999F)) continue;
            double sum = 0.0, squares = 0.0;
            for (Progressive& picture : pictures) {
                const auto value = static_cast<double>(picture.image.layer(colour)[i]);
                sum += value;
                squares += value * value;
            }
            means.push_back(sum / seeds);
            variances.push_back((squares - sum * sum / seeds) / (seeds - 1));
            mean += sum / seeds;
        }
    mean /= static_cast<double>(means.size());
    double actual = 0.0, told = 0.0, toldSquares = 0.0;
    for (std::size_t i = 0; i < means.size(); ++i)
        actual += variances[i] / (means[i] * means[i] + 0.01 * mean * mean) / static_cast<double>(means.size());
    for (const Progressive& picture : pictures) {
        told += picture.noise / seeds;
        toldSquares += picture.noise * picture.noise / seeds;
    }
    // the error of the actual noise is at most that of what is told, which has one degree of freedom a picture too
    const double error = std::sqrt(2.0 * (toldSquares - told * told) / (seeds - 1));
    EXPECT_GT(actual, 0.0);
    EXPECT_LT(error, 0.2 * actual) << "else this test says nothing";
    EXPECT_NEAR(told, actual, 4.0 * error);
}

TEST(Progressive, SameBitsAsAPictureThatKnowsItsPhotons) {
    scene::Scene scene = smallScene();
    constexpr int generations = 7;  // the scene's own are 2
    const std::int64_t each = scene.photonMap.photons / scene.photonMap.generations;
    const LayeredImage progressive = pictureOf(scene, generations).image;
    scene.photonMap.photons = each * generations;
    scene.photonMap.generations = generations;
    const test::Frame known = test::render(scene);
    EXPECT_EQ(known.statistics.generations, static_cast<std::uint64_t>(generations));
    for (const auto& [name, values] : known.image.layers) EXPECT_EQ(values, progressive.layers.at(name)) << name;
}

/// What the sum took is not in the halves, and its part in the noise is told all the same.
TEST(Progressive, GoesOnAfterDrawing) {
    const scene::Scene scene = smallScene();
    Renderer renderer(scene, progressiveOptions(true));
    for (int i = 0; i < 3; ++i) renderer.traceGeneration();
    renderer.draw();
    for (int i = 0; i < 4; ++i) renderer.traceGeneration();
    const Preview preview = renderer.preview();
    EXPECT_EQ(preview.evenGenerations + preview.oddGenerations, 4);
    EXPECT_GT(preview.forecastSeconds, 0.0);
    const LayeredImage resumed = renderer.draw();
    const LayeredImage whole = pictureOf(scene, 7).image;
    for (const char* name : {"R", "G", "B"}) EXPECT_EQ(resumed.layers.at(name), whole.layers.at(name)) << name;
    EXPECT_EQ(renderer.statistics().generations, 7U);
    for (const std::string& message : renderer.statistics().validationMessages) ADD_FAILURE() << message;
}

TEST(Progressive, StopsAtTheTarget) {
    const scene::Scene scene = smallScene();
    double before = 0.0;
    for (const double target : {0.03, 0.01}) {
        Renderer renderer(scene, progressiveOptions());
        const Reached reached = traceUntil(renderer, {{}, target, 0.0}, noTime, noReport);
        EXPECT_EQ(reached.stop, Stop::targetError);
        ASSERT_TRUE(reached.noise);
        EXPECT_LE(*reached.noise, target);
        EXPECT_GT(*reached.noise, 0.2 * target) << "far beyond the target";
        EXPECT_GT(reached.generations, before);
        before = reached.generations;
    }
}

TEST(Progressive, StopsInTimeToDrawAndWrite) {
    const scene::Scene scene = smallScene();
    for (const double after : {0.0, 60.0}) {
        Renderer renderer(scene, progressiveOptions());
        double now = 0.0;  // each look at the clock takes a second
        const Reached reached = traceUntil(
            renderer, {100.0, {}, after}, [&now] { return now += 1.0; }, noReport);
        EXPECT_EQ(reached.stop, Stop::seconds);
        EXPECT_LE(now + after, 103.0) << "with a look between two rounds";
        EXPECT_GT(now + after, 90.0);
        EXPECT_TRUE(reached.noise);
    }
    Renderer renderer(scene, progressiveOptions());
    const Reached reached = traceUntil(
        renderer, {1e-3, {}, 0.0}, [] { return 1.0; }, noReport);
    EXPECT_EQ(reached.generations, 1) << "too little time: one generation all the same";
    EXPECT_FALSE(reached.noise);
}

/// A scene in which no generation of its photons ends in time has a picture all the same, in twice the time.
TEST(Progressive, AVeryThickCloudEndsInTime) {
    for (const double extinction : {1e2, 1e5}) {
        scene::Scene scene = smallScene();
        scene.clouds[0].extinction = extinction;
        scene.clouds[0].phase.g = 0.0;
        scene.photonMap.photons = 200'000;
        Renderer renderer(scene, progressiveOptions());
        double now = 0.0;  // each look at the clock takes a second, and a round has one look
        const Reached reached = traceUntil(
            renderer, {20.0, {}, 0.0}, [&now] { return now += 1.0; }, noReport);
        EXPECT_EQ(reached.stop, Stop::seconds);
        EXPECT_LE(now, 40.0);
        EXPECT_GE(reached.generations, 1);
        EXPECT_GT(reached.photonsEach, 0U);
        EXPECT_LT(reached.photonsEach, 100'000U);
        const LayeredImage image = renderer.draw();
        float brightest = 0.0F;
        for (const float value : image.layers.at("cloud.G")) {
            ASSERT_TRUE(std::isfinite(value));
            brightest = std::max(brightest, value);
        }
        EXPECT_GT(brightest, 0.0F);
        EXPECT_EQ(renderer.statistics().lost > 0, reached.unfinished);
    }
}

TEST(Progressive, ASceneWithoutPhotonsHasNoNoise) {
    scene::Scene scene = smallScene();
    scene.clouds[0].albedo = glm::dvec3(0.0);
    Renderer renderer(scene, progressiveOptions());
    const Reached reached = traceUntil(renderer, {1.0, 1e-6, 0.0}, noTime, noReport);
    EXPECT_EQ(reached.stop, Stop::photons);
    EXPECT_EQ(reached.generations, 0);
    EXPECT_EQ(reached.noise, 0.0);
}

}  // namespace
}  // namespace lumulus::progressive
