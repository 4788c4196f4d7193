#include "cli/render.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <span>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/version.h"
#include "cli/output.h"
#include "cli/stats_json.h"
#include "renderer.h"
#include "scene/load.h"

namespace lumulus::cli {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool statsToFile(const RenderOptions& options) {
    return !options.stats.empty() && options.stats != "-";
}

/// Everything that can be known to fail later fails here, before the work.
void checkOutputs(const RenderOptions& options) {
    std::vector<std::filesystem::path> outputs = options.outputs;
    for (const auto& output : outputs) requireSuffix(output, {".exr", ".png"});
    if (statsToFile(options)) outputs.emplace_back(options.stats);
    checkPlaces(outputs);
}

scene::Scene sceneOf(const RenderOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (options.seed) overrides.push_back("photon_map.seed=" + std::to_string(*options.seed));
    return scene::loadScene(options.scene, overrides, options.quality);
}

LayeredImage renderFrame(Renderer& renderer, Steps& steps) {
    const auto generations = static_cast<std::uint64_t>(renderer.generationsWanted());
    steps.report("photons", 0, generations);
    for (std::uint64_t done = 0; done < generations; ++done) {
        stopIfInterrupted();
        renderer.traceGeneration();
        steps.report("photons", done + 1, generations);
    }
    stopIfInterrupted();
    LayeredImage image = renderer.draw();
    stopIfInterrupted();
    return image;
}

void writeOutputs(const RenderOptions& options, const LayeredImage& image, double exposure, Steps& steps) {
    steps.report("writing", 0, 1);
    for (const auto& output : options.outputs) writePicture(output, image, exposure);
    steps.report("writing", 1, 1);
}

}  // namespace

void runRender(const RenderOptions& options) {
    const Clock::time_point start = Clock::now();
    checkOutputs(options);
    const scene::Scene scene = sceneOf(options);

    Steps steps(options.quiet);
    Renderer renderer(scene, RendererOptions{options.device, options.validate, steps.reporter()});
    LayeredImage image = renderFrame(renderer, steps);
    const Statistics statistics = renderer.statistics();
    for (const std::string& warning : statistics.warnings) logWarning(warning);

    image.attributes["scene"] = scene.source;
    image.attributes["seed"] = std::to_string(scene.photonMap.seed);
    image.attributes["software"] = std::string("lumulus ") + version;
    image.attributes["device"] = statistics.device;
    image.attributes["samples"] = std::to_string(statistics.photons);
    image.attributes["seconds"] = std::to_string(secondsSince(start));

    const Clock::time_point writing = Clock::now();
    writeOutputs(options, image, scene.image.exposure, steps);
    const double writeSeconds = secondsSince(writing);
    writeStatistics(options.stats, statisticsJson(statistics, writeSeconds, secondsSince(start)));
    requireNoMessages(options.validate, statistics);
}

}  // namespace lumulus::cli
