#include "bench/render_runs.h"

#include <chrono>

#include "base/interrupt.h"
#include "bench/plan.h"
#include "render/renderer.h"

namespace lumulus::bench {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Timed {
    LayeredImage image;
    double seconds = 0.0, warmSeconds = 0.0, photons = 0.0;
};

/// Traces a generation and returns its seconds.
double traceOne(Renderer& renderer) {
    stopIfInterrupted();
    const Clock::time_point start = Clock::now();
    renderer.traceGeneration();
    return secondsSince(start);
}

Timed renderOnce(const scene::Scene& scene, const std::string& device) {
    Timed timed;
    const Clock::time_point start = Clock::now();
    Renderer renderer(scene, RendererOptions{device, false});
    const int generations = renderer.generationsWanted();
    if (generations > 0) traceOne(renderer);
    double warm = 0.0;
    for (int i = 1; i < generations; ++i) warm += traceOne(renderer);
    timed.image = renderer.draw();
    timed.seconds = secondsSince(start);
    timed.photons = static_cast<double>(renderer.statistics().photons);

    const Clock::time_point again = Clock::now();
    renderer.draw();
    timed.warmSeconds = secondsSince(again);
    if (generations > 1) timed.warmSeconds += warm * generations / (generations - 1.0);
    if (generations == 1) timed.warmSeconds += traceOne(renderer);
    return timed;
}

Cost costOf(scene::Scene scene, const std::string& device) {
    constexpr std::int64_t few = 20000, more = 200000;
    scene.photonMap.photons = few;
    scene.photonMap.photonsGiven = true;
    const Timed less = renderOnce(scene, device);
    scene.photonMap.photons = more;
    return costFrom({few, less.warmSeconds}, {more, renderOnce(scene, device).warmSeconds});
}

}  // namespace

std::vector<Run> renderRuns(const scene::Scene& scene, const std::string& device, const Truth& truth,
                            std::span<const double> budgets, std::span<const std::uint64_t> seeds, Progress& progress) {
    // with fewer photons a generation is nothing but overhead
    const std::int64_t fewest = std::int64_t{100} * scene.photonMap.generations;
    std::vector<Run> runs;
    const std::vector<PhotonBudget> plan = planPhotons(budgets, costOf(scene, device), fewest);
    for (const PhotonBudget& budget : plan) {
        for (const std::uint64_t seed : seeds) {
            scene::Scene wanted = scene;
            wanted.photonMap.photons = budget.photons;
            wanted.photonMap.photonsGiven = true;
            wanted.photonMap.seed = seed;
            const Timed timed = renderOnce(wanted, device);
            runs.push_back({Method::render, budget.seconds, timed.seconds, timed.warmSeconds, timed.photons,
                            measure(timed.image, truth)});
            progress.advance();
        }
    }
    progress.advance((budgets.size() - plan.size()) * seeds.size());
    return runs;
}

}  // namespace lumulus::bench
