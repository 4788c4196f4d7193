// What a camera move costs when the photon map is full, against one sample in every pixel of the path tracer, and a
// generation of photons beside it, all in one process and in turns: move_bench SCENE [section.key=value…], for example
// move_bench configs/scenes/cumulus-side-lit.toml photon_map.photons=1000000 photon_map.generations=10.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "bench/bench_main.h"
#include "reference/render.h"
#include "render/renderer.h"
#include "scene/load.h"
#include "volume/load.h"

namespace lumulus::bench {

namespace {

constexpr int turns = 3;
// Moves are shorter than a sample, and their times scatter more.
constexpr int movesARound = 4;
// The tracer's samples 5, 6 and 7: others, whose numbers are powers of two, look up transmittance too and take longer.
constexpr int samplesBefore = 4;
constexpr double degreesAMove = 2.0;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// The view from a camera that has gone round the cloud.
View turned(const Renderer& renderer, double degrees) {
    View view = renderer.sceneView();
    const Camera camera = makeCamera(view, renderer.bounds());
    const glm::dvec3 middle = renderer.bounds().centre;
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0.0, 1.0, 0.0)));
    view.camera.position = middle + turn * (camera.position - middle);
    view.camera.target = middle + turn * (camera.position + 1000.0 * camera.axes[2] - middle);
    return view;
}

/// A renderer with a full map that has drawn once.
class Mover {
  public:
    Mover(scene::Scene scene, scene::DrawMode mode) : renderer_(withMode(std::move(scene), mode), {}) {
        for (int i = 0; i < renderer_.generationsWanted(); ++i) renderer_.traceGeneration();
        renderer_.draw(renderer_.sceneView(), viewer_);
    }

    void move() {
        const View view = turned(renderer_, degreesAMove * static_cast<double>(seconds_.size() + 1));
        const Stopwatch watch;
        renderer_.draw(view, viewer_);
        seconds_.push_back(watch.seconds());
    }

    double generation() {
        const Stopwatch watch;
        renderer_.traceGeneration();
        return watch.seconds();
    }

    double seconds() const { return median(seconds_); }
    Statistics statistics() const { return renderer_.statistics(); }

  private:
    static scene::Scene withMode(scene::Scene scene, scene::DrawMode mode) {
        scene.draw.mode = mode;
        return scene;
    }

    Renderer renderer_;
    ViewState viewer_;  // gives back what it holds before the renderer does
    std::vector<double> seconds_;
};

void print(const char* what, double seconds, double sample) {
    fmt::print("{:<30}{:>9.3f} s{:>8.2f}\n", what, seconds, seconds / sample);
}

void run(const std::string& path, const std::vector<std::string>& overrides) {
    const scene::Scene scene = scene::loadScene(path, overrides);
    const CloudVolumes clouds = loadClouds(scene);
    reference::Renderer tracer(scene, clouds.placed(), reference::Majorant::local, 1);
    Mover march(scene, scene::DrawMode::march), billboards(scene, scene::DrawMode::billboards);
    std::vector<double> samples, generations;
    const auto sampleOnce = [&] { tracer.pass([](std::uint64_t) { return true; }); };
    for (int warm = 0; warm < samplesBefore; ++warm) sampleOnce();
    for (int turn = 0; turn < turns; ++turn) {
        const Stopwatch watch;
        sampleOnce();
        samples.push_back(watch.seconds());
        for (int i = 0; i < movesARound; ++i) {
            march.move();
            billboards.move();
        }
    }
    const Statistics marched = march.statistics(), shown = billboards.statistics();
    for (int turn = 0; turn < turns; ++turn) generations.push_back(march.generation());
    const double sample = median(samples);
    fmt::print("{}x{} pixels, medians of {} and {} moves  against the sample\n", scene.image.width, scene.image.height,
               turns, turns * movesARound);
    print("path tracer, 1 sample a pixel", sample, sample);
    print("move, marched", march.seconds(), sample);
    print("move, billboards", billboards.seconds(), sample);
    print(fmt::format("generation of {} photons",
                      scene.photonMap.photons / static_cast<std::uint64_t>(scene.photonMap.generations))
              .c_str(),
          median(generations), sample);
    for (const Statistics& statistics : {marched, shown})
        for (const PassTime& pass : statistics.passes)
            fmt::print("  {:<18}{:>8.1f} ms\n", pass.name, pass.milliseconds);
}

}  // namespace

}  // namespace lumulus::bench

int main(int argc, char** argv) {
    return lumulus::bench::benchMain("move_bench", argc, argv, lumulus::bench::run);
}
