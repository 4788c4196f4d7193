#include "bench/path_tracer_runs.h"

#include <chrono>

#include "base/error.h"
#include "base/interrupt.h"
#include "reference/render.h"
#include "volume/load.h"

namespace lumulus::bench {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

reference::Renderer tracerOf(const scene::Scene& scene, std::uint64_t seed) {
    const CloudVolumes clouds = loadClouds(scene);
    return {scene, clouds.placed(), reference::Majorant::local, seed};
}

/// Runs passes until `budget` seconds are spent. `spent` is the time of earlier passes; returns the time of all passes.
double passUntil(reference::Renderer& tracer, double budget, double spent) {
    while (spent < budget || tracer.film().samples == 0) {
        const Clock::time_point start = Clock::now();
        if (!tracer.pass([](std::uint64_t) { return !interrupted(); })) {
            throw Error("interrupted", "", "nothing was written");
        }
        spent += secondsSince(start);
    }
    return spent;
}

void addRuns(std::vector<Run>& runs, const scene::Scene& scene, const Truth& truth, std::span<const double> budgets,
             std::uint64_t seed, Progress& progress) {
    const Clock::time_point start = Clock::now();
    reference::Renderer tracer = tracerOf(scene, seed);
    const double preparing = secondsSince(start);
    double spent = 0.0;
    for (const double budget : budgets) {
        spent = passUntil(tracer, budget, spent);
        const Clock::time_point finishing = Clock::now();
        const LayeredImage image = tracer.picture();
        const double warm = spent + secondsSince(finishing);
        runs.push_back({Method::pathTracer, budget, preparing + warm, warm, static_cast<double>(tracer.film().samples),
                        measure(image, truth)});
        progress.advance();
    }
}

}  // namespace

std::vector<Run> pathTracerRuns(const scene::Scene& scene, const Truth& truth, std::span<const double> budgets,
                                std::span<const std::uint64_t> seeds, Progress& progress) {
    std::vector<Run> runs;
    for (const std::uint64_t seed : seeds) addRuns(runs, scene, truth, budgets, seed, progress);
    return runs;
}

}  // namespace lumulus::bench
