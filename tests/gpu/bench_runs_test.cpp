#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "bench/path_tracer_runs.h"
#include "bench/render_runs.h"
#include "reference/render.h"
#include "support/small_scene.h"
#include "volume/load.h"

// What the benchmark measures is what `render` and `reference` would make: the same bits.
namespace lumulus::bench {
namespace {

LayeredImage traced(const scene::Scene& scene, std::uint64_t seed, std::uint64_t samples) {
    const CloudVolumes clouds = loadClouds(scene);
    reference::Renderer tracer(scene, clouds.placed(), reference::Majorant::local, seed);
    while (tracer.film().samples < samples) tracer.pass([](std::uint64_t) { return true; });
    return tracer.picture();
}

Truth truthOf(const scene::Scene& scene) {
    return makeTruth(traced(scene, 99, 32), "truth", scene.image.width, scene.image.height, 0.0);
}

void expectSame(const Errors& a, const Errors& b) {
    EXPECT_EQ(a.relMse, b.relMse);
    EXPECT_EQ(a.rmse, b.rmse);
    EXPECT_EQ(a.flip, b.flip);
    EXPECT_EQ(a.bias, b.bias);
    EXPECT_EQ(a.relativeBias, b.relativeBias);
}

TEST(BenchRuns, PathTracerSpendsItsBudgets) {
    const scene::Scene scene = test::smallScene();
    const Truth truth = truthOf(scene);
    const std::array budgets{1e-6, 0.05};
    const std::array<std::uint64_t, 2> seeds{3, 4};
    Progress progress("test", 4, true);
    const std::vector<bench::Run> runs = pathTracerRuns(scene, truth, budgets, seeds, progress);
    ASSERT_EQ(runs.size(), 4U);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const bench::Run& run = runs[i];
        EXPECT_EQ(run.method, Method::pathTracer);
        EXPECT_EQ(run.budget, budgets[i % 2]);
        EXPECT_GE(run.warmSeconds, run.budget);
        EXPECT_GE(run.seconds, run.warmSeconds);
        expectSame(run.errors, measure(traced(scene, seeds[i / 2], static_cast<std::uint64_t>(run.amount)), truth));
    }
    EXPECT_EQ(runs[0].amount, 1.0);  // one pass, however small the budget
    EXPECT_GE(runs[1].amount, runs[0].amount);
}

TEST(BenchRuns, RenderTakesTheSeedAndAtLeastAHundredPhotonsAGeneration) {
    scene::Scene scene = test::smallScene();
    const Truth truth = truthOf(scene);
    const std::array budgets{1e-7, 1e-6};  // nothing is so fast: both mean the fewest photons, and count once
    const std::array<std::uint64_t, 1> seed{3};
    Progress progress("test", 2, true);
    const std::vector<bench::Run> runs = renderRuns(scene, "", truth, budgets, seed, progress);
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_EQ(runs[0].method, Method::render);
    EXPECT_EQ(runs[0].amount, 200.0);
    EXPECT_GT(runs[0].seconds, 0.0);
    EXPECT_GT(runs[0].warmSeconds, 0.0);
    scene.photonMap.photons = 200;
    scene.photonMap.seed = 3;
    expectSame(runs[0].errors, measure(test::render(scene).image, truth));
}

}  // namespace
}  // namespace lumulus::bench
