// Clouds that come, go and change while a renderer lives: photons of those that stay are kept.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

/// Two balls of other extinctions, beside each other in the picture.
scene::Scene twoBalls() {
    scene::Scene scene = test::smallScene();
    scene.image = {64, 24, 0.0};
    scene.camera.position = dvec3(0.0, 100.0, 900.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.camera.verticalFov = 20.0;
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[0].name = "west";
    scene.clouds[1].name = "east";
    scene.clouds[0].transform[3].x = -200.0;
    scene.clouds[1].transform[3].x = 200.0;
    scene.clouds[1].extinction = 0.02;
    scene.photonMap.photons = 40000;
    scene.photonMap.generations = 4;
    return scene;
}

scene::Scene onlyFirst(scene::Scene scene) {
    scene.clouds.resize(1);
    return scene;
}

void trace(Renderer& renderer) {
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
}

/// Mean light of the clouds alone in the left (0) or right half of the picture (1).
double meanOf(const LayeredImage& image, int half) {
    double sum = 0.0;
    const std::vector<float>& green = image.layers.at("cloud.G");
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width / 2; ++x)
            sum += static_cast<double>(green[static_cast<std::size_t>(y * image.width + x + half * image.width / 2)]);
    return sum / (0.5 * image.width * image.height);
}

/// Mean and standard error of a half of the picture of a scene, over seeds, where the map is made for it.
struct Truth {
    double mean = 0.0, deviation = 0.0;
};
Truth truthOf(scene::Scene scene, int half) {
    constexpr int seeds = 4;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < seeds; ++i) {
        scene.photonMap.seed = static_cast<std::uint64_t>(100 + i);
        Renderer renderer(scene, withRing());
        trace(renderer);
        const double mean = meanOf(renderer.draw(), half);
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / seeds;
    return {mean, std::sqrt(std::max(0.0, squares / seeds - mean * mean) * seeds / (seeds - 1))};
}

/// Within five deviations of one picture, which four of them tell roughly, and a per mille for rounding of cells.
void expectTrue(double mean, const Truth& truth, const char* what) {
    EXPECT_NEAR(mean, truth.mean, 5.0 * truth.deviation + 1e-3 * truth.mean) << what;
}

TEST(RendererEdited, NothingChangesWhereNothingIsEdited) {
    for (const scene::Scene& scene : {twoBalls(), onlyFirst(twoBalls())}) {
        Renderer first(scene, withRing());
        trace(first);
        first.traceGeneration();
        const LayeredImage before = first.draw();
        std::vector<CloudOrigin> origins;
        for (std::size_t i = 0; i < scene.clouds.size(); ++i) origins.push_back({i});
        Renderer second(scene, first, origins, withRing());
        EXPECT_EQ(second.generations().count, first.generations().count);
        EXPECT_EQ(second.generations().current, 0);
        EXPECT_EQ(second.draw().layers, before.layers) << "photons are those of before, bit by bit";
        first.traceGeneration();
        second.traceGeneration();
        EXPECT_EQ(second.draw().layers, first.draw().layers) << "and so are those that come";
    }
}

TEST(RendererEdited, ACloudComes) {
    const scene::Scene both = twoBalls(), one = onlyFirst(both);
    Renderer first(one, withRing());
    trace(first);
    const double before = meanOf(first.draw(), 0);
    CloudOrigin added{0, true};
    added.move = dvec3(400.0, 0.0, 0.0);
    Renderer second(both, first, std::vector<CloudOrigin>{{0}, added}, withRing());
    const LayeredImage atOnce = second.draw();
    EXPECT_NEAR(meanOf(atOnce, 0), before, 0.02 * before) << "light of the one that stays is there";
    // the one that comes has the sun's first scattering at once, and its photons from the first generation on: the mean
    // of those that have seen it
    const Truth west = truthOf(both, 0), east = truthOf(both, 1);
    second.traceGeneration();
    EXPECT_NEAR(meanOf(second.draw(), 1), east.mean, 0.1 * east.mean);
    for (int i = 1; i < second.generationsWanted(); ++i) second.traceGeneration();
    EXPECT_EQ(second.generations().current, second.generationsWanted());
    const LayeredImage after = second.draw();
    expectTrue(meanOf(after, 0), west, "the first cloud");
    expectTrue(meanOf(after, 1), east, "the cloud that came");
    EXPECT_EQ(first.draw().layers.at("cloud.G").size(), after.layers.at("cloud.G").size());
    EXPECT_DOUBLE_EQ(meanOf(first.draw(), 0), before) << "the renderer of before is as it was";
}

TEST(RendererEdited, ACloudGoes) {
    const scene::Scene both = twoBalls(), one = onlyFirst(both);
    Renderer first(both, withRing());
    trace(first);
    Renderer second(one, first, std::vector<CloudOrigin>{{0}}, withRing());
    const LayeredImage atOnce = second.draw();
    EXPECT_DOUBLE_EQ(meanOf(atOnce, 1), 0.0);
    EXPECT_NEAR(meanOf(atOnce, 0), meanOf(first.draw(), 0), 0.02 * meanOf(atOnce, 0));
    trace(second);
    expectTrue(meanOf(second.draw(), 0), truthOf(one, 0), "the cloud that stays");
}

TEST(RendererEdited, ACloudIsOfAnotherSubstance) {
    const scene::Scene before = twoBalls();
    scene::Scene darker = before;
    darker.clouds[1].albedo = dvec3(0.5);
    darker.clouds[1].phase.g = 0.3;
    Renderer first(before, withRing());
    trace(first);
    CloudOrigin other{1};
    other.substance = true;
    Renderer second(darker, first, std::vector<CloudOrigin>{{0}, other}, withRing());
    EXPECT_EQ(second.generations().count, 4);
    trace(second);
    const LayeredImage after = second.draw();
    expectTrue(meanOf(after, 0), truthOf(darker, 0), "the cloud beside it");
    expectTrue(meanOf(after, 1), truthOf(darker, 1), "the cloud that changed");
}

TEST(RendererEdited, TheirPlaces) {
    scene::Scene scene = onlyFirst(twoBalls());
    Renderer first(scene, withRing());
    first.moveCloud({0.0, 30.0, 0.0}, 0);
    CloudOrigin larger{0, true};
    larger.scale = 1.5;
    larger.yaw = 0.7;
    larger.move = dvec3(400.0, 0.0, 0.0);
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[1].name = "east";
    Renderer second(scene, first, std::vector<CloudOrigin>{{0}, larger}, withRing());
    EXPECT_EQ(second.clouds(), (std::vector<std::string>{"west", "east"}));
    // a ball of 150 m about (200, 100, 0), and that of 100 m which was moved
    const query::Media media = second.media();
    const auto depth = [&](const dvec3& from, const dvec3& to) {
        const query::Segment segment{from, to};
        return query::alongSegments(media, std::span(&segment, 1), stopIfInterrupted).front().opticalDepth.g;
    };
    // to a tenth of a voxel, whose edge is 12.5 m before it is scaled
    EXPECT_NEAR(depth({200, 100, -900}, {200, 100, 900}), 0.01 * 300.0, 0.04);
    EXPECT_NEAR(depth({200, 220, -900}, {200, 220, 900}), 0.01 * 2.0 * std::sqrt(150.0 * 150.0 - 120.0 * 120.0), 0.1);
    EXPECT_NEAR(depth({-200, 130, -900}, {-200, 130, 900}), 0.01 * 200.0, 0.02);
    EXPECT_EQ(depth({-200, 10, -900}, {-200, 10, 900}), 0.0);
}

}  // namespace
}  // namespace lumulus
