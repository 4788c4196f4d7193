// What densities in bricks cost: sparse_bench SCENE [section.key=value…] traces and draws the scene and prints seconds
// and memory; with --compare in front it does so with dense and sparse storage in turns, in one process, and prints the
// ratio.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "scene/load.h"

namespace {

using namespace lumulus;  // NOLINT: a program of its own

double processSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double peakMiB() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_maxrss) / 1024.0;
}

struct Turn {
    double trace = 0.0, draw = 0.0;  ///< seconds of all threads
    double events = 0.0;
};

Turn takeTurn(Renderer& renderer) {
    Turn turn;
    const double events = static_cast<double>(renderer.statistics().events);
    const double start = processSeconds();
    renderer.traceGeneration();
    const double traced = processSeconds();
    renderer.draw();
    turn.trace = traced - start;
    turn.draw = processSeconds() - traced;
    turn.events = static_cast<double>(renderer.statistics().events) - events;
    return turn;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void compare(scene::Scene scene) {
    scene.preparation.storage = scene::DensityStorage::dense;
    Renderer dense(scene, {});
    scene.preparation.storage = scene::DensityStorage::sparse;
    Renderer sparse(scene, {});
    std::vector<double> walk[2], march[2];
    constexpr int turns = 5;
    for (int turn = 0; turn <= turns; ++turn)
        for (int kind = 0; kind < 2; ++kind) {
            const Turn taken = takeTurn(kind == 0 ? dense : sparse);
            if (turn == 0) continue;  // programs are made in the first one
            walk[kind].push_back(1e9 * taken.trace / taken.events);
            march[kind].push_back(taken.draw);
        }
    fmt::print("walk   dense {:.0f} ns, sparse {:.0f} ns a collision: {:.2f}\n", median(walk[0]), median(walk[1]),
               median(walk[1]) / median(walk[0]));
    fmt::print("draw   dense {:.2f} s, sparse {:.2f} s: {:.2f}\n", median(march[0]), median(march[1]),
               median(march[1]) / median(march[0]));
    for (const auto& [name, renderer] : {std::pair("dense", &dense), std::pair("sparse", &sparse)}) {
        const Statistics s = renderer->statistics();
        fmt::print("{:6} {} collectors, {:.1f} MiB on the GPU, prepared in {:.2f} s\n", name, s.collectors,
                   static_cast<double>(s.gpuBytes) / 1048576.0, s.prepareSeconds);
    }
}

void measure(const scene::Scene& scene) {
    Renderer renderer(scene, {});
    const double loaded = peakMiB();
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    renderer.draw();
    const Statistics s = renderer.statistics();
    for (const std::string& warning : s.warnings) fmt::print("warning: {}\n", warning);
    for (const CloudSummary& cloud : s.clouds) {
        if (!cloud.bricks) continue;
        const BrickSummary& b = *cloud.bricks;
        fmt::print("{} leaves; bricks: {} dense, {} constant, {} empty; slots by level {} {} {} {} of {}-byte texels\n",
                   b.leaves, b.dense, b.constant, b.empty, b.levels[0], b.levels[1], b.levels[2], b.levels[3],
                   b.bytesOfTexel);
        fmt::print("pool {:.1f}, index {:.1f}, collector index {:.1f}, majorants {:.1f} MiB\n",
                   static_cast<double>(b.poolBytes) / 1048576.0, static_cast<double>(b.indexBytes) / 1048576.0,
                   static_cast<double>(b.collectorIndexBytes) / 1048576.0,
                   static_cast<double>(b.majorantBytes) / 1048576.0);
    }
    fmt::print(
        "load {:.1f}, prepare {:.1f}, trace {:.1f}, draw {:.1f} s; GPU {:.0f} MiB, process at most {:.0f} MiB "
        "({:.0f} when loaded); {} collectors, {} events\n",
        s.loadSeconds, s.prepareSeconds, s.traceSeconds, s.drawSeconds, static_cast<double>(s.gpuBytes) / 1048576.0,
        peakMiB(), loaded, s.collectors, s.events);
}

}  // namespace

int main(int count, char** arguments) {
    try {
        std::vector<std::string> words(arguments + 1, arguments + count);
        const bool both = !words.empty() && words[0] == "--compare";
        if (both) words.erase(words.begin());
        if (words.empty()) {
            fmt::print(stderr, "sparse_bench [--compare] SCENE [section.key=value…]\n");
            return 2;
        }
        const std::vector<std::string> settings(words.begin() + 1, words.end());
        const scene::Scene scene = scene::loadScene(words[0], settings);
        both ? compare(scene) : measure(scene);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
