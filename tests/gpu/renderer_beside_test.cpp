#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "render/renderer.h"
#include "support/small_scene.h"

// Renderers of one scene that differ in light share its clouds.
namespace lumulus {
namespace {

RendererOptions withRing() {
    RendererOptions options;
    options.keepRing = true;
    return options;
}

LayeredImage traced(Renderer& renderer) {
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    return renderer.draw();
}

TEST(RendererBeside, HasLightOfItsOwn) {
    const scene::Scene scene = test::smallScene();
    auto first = std::make_unique<Renderer>(scene, withRing());
    const LayeredImage before = traced(*first);
    const std::uint64_t alone = first->statistics().gpuBytes;

    Renderer second(scene, *first, withRing());
    EXPECT_EQ(second.generations().count, 0);
    EXPECT_EQ(traced(second).layers, before.layers) << "the same scene has the same bits";
    EXPECT_EQ(second.statistics().collectors, first->statistics().collectors);

    second.setSun({0.0, 1.0, 0.0}, {9.0, 9.0, 9.0});
    second.setExtinction(2.0 * scene.clouds[0].extinction);
    second.setOffset({1000.0, 0.0, 0.0});
    const LayeredImage changed = traced(second);
    EXPECT_NE(changed.layers, before.layers);
    EXPECT_EQ(first->sun().irradiance, scene.sun.irradiance);
    EXPECT_EQ(first->extinction(), scene.clouds[0].extinction);
    EXPECT_EQ(first->draw().layers, before.layers) << "the light of the first has not changed";

    Renderer third(scene, second, withRing());
    EXPECT_EQ(traced(third).layers, before.layers) << "light as the scene has it, whatever the other's";
    EXPECT_LT(third.statistics().gpuBytes, 3 * alone) << "bytes of all three: the clouds are there once";

    const LayeredImage last = second.draw();
    first.reset();
    EXPECT_EQ(second.draw().layers, last.layers) << "the clouds outlive the renderer that loaded them";
}

/// Between the rounds of a generation pictures can be drawn, which show the light of before, and light can change: the
/// generation does not count as one of the new light then.
TEST(RendererBeside, PicturesAndChangesBetweenRounds) {
    scene::Scene scene = test::smallScene();
    scene.photonMap.photons = 1000000;  // many rounds
    Renderer* between = nullptr;
    std::vector<LayeredImage> drawn;
    RendererOptions options = withRing();
    options.check = [&] {
        if (Renderer* renderer = std::exchange(between, nullptr)) {
            drawn.push_back(renderer->draw());
            between = drawn.size() < 3 ? renderer : nullptr;
        }
    };
    Renderer renderer(scene, options), other(scene, withRing());
    CutOff shortRounds;
    shortRounds.roundSeconds = [] { return 1e-9; };
    for (Renderer* each : {&renderer, &other}) each->traceGeneration();
    const LayeredImage before = other.draw();
    between = &renderer;
    ASSERT_TRUE(renderer.traceGeneration(shortRounds));
    ASSERT_EQ(drawn.size(), 3U);
    between = nullptr;
    for (const LayeredImage& picture : drawn) EXPECT_EQ(picture.layers, before.layers);
    EXPECT_EQ(renderer.generations().current, 2);
    other.traceGeneration();
    EXPECT_EQ(renderer.draw().layers, other.draw().layers);

    shortRounds.roundSeconds = [&] {
        renderer.setSun({0.0, 1.0, 0.0}, {9.0, 9.0, 9.0});
        return 1e-9;
    };
    ASSERT_TRUE(renderer.traceGeneration(shortRounds));
    EXPECT_EQ(renderer.generations().current, 0) << "the light has changed while it was traced";
    ASSERT_TRUE(renderer.traceGeneration(CutOff{}));
    EXPECT_EQ(renderer.generations().current, 1);
    other.traceGeneration();
    other.setSun({0.0, 1.0, 0.0}, {9.0, 9.0, 9.0});
    other.traceGeneration();
    EXPECT_EQ(renderer.draw().layers, other.draw().layers) << "a generation has the sun with which it began";
}

}  // namespace
}  // namespace lumulus
