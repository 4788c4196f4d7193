#include "cli/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "base/atomic_file.h"
#include "base/display_transform.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/clouds_told.h"
#include "cli/output.h"
#include "cli/picture_files.h"
#include "cli/render_error.h"
#include "cli/render_frames.h"
#include "cli/stats_json.h"
#include "progressive/trace_until.h"
#include "render/renderer.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"
#include "volume/far_parts.h"
#include "volume/place_clouds.h"

namespace lumulus::cli {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool statsToFile(const RenderOptions& options) {
    return !options.stats.empty() && options.stats != "-";
}

/// Checks before the work everything that could fail after it.
void checkOutputs(const RenderOptions& options) {
    std::vector<std::filesystem::path> outputs = options.outputs;
    for (const auto& output : outputs) requireSuffix(output, {".exr", ".png"});
    DisplayTransform::ofEnvironment();
    if (statsToFile(options)) outputs.emplace_back(options.stats);
    if (!options.maps.out.empty()) outputs.push_back(options.maps.out);
    checkPlaces(outputs);
}

scene::Scene sceneOf(const RenderOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (options.seed) overrides.push_back("photon_map.seed=" + std::to_string(*options.seed));
    scene::Scene scene = scene::loadScene(options.scene, overrides, options.quality);
    scene::requireBoundedFog(scene);
    return divideFarParts(placeClouds(std::move(scene)));
}

void requirePositive(const std::optional<double>& value, const char* option) {
    if (value && !(*value > 0.0 && std::isfinite(*value)))
        throw InputError(fmt::format("{} is no limit", *value), option, "give a number above 0");
}

bool progressive(const RenderOptions& options) {
    return options.seconds || options.targetError;
}

/// Checks that there is something to write, and by one way.
void requireSomeOutput(const RenderOptions& options) {
    if (options.outputs.empty() && options.maps.out.empty())
        throw InputError("nothing is to be written", "-o", "give a picture, or a photon map by --map-out");
    if (options.error.used() && options.outputs.empty())
        throw InputError("there is no picture whose error could be measured", "--error", "give one by -o");
    if (progressive(options) && options.maps.used())
        throw InputError("photon maps in files have a number of generations that is known before",
                         options.seconds ? "--seconds" : "--target-error",
                         "leave it out, or leave out --map-in, --map-out and --generations");
}

/// Estimates the seconds of writing from measurements on one core of 2023. Compression takes most of them.
double writingForecast(const RenderOptions& options, const scene::Image& image) {
    constexpr double exrPixel = 6e-7, pngPixel = 3e-7;
    double perPixel = 0.0;
    for (const auto& output : options.outputs) perPixel += hasSuffix(output, ".exr") ? exrPixel : pngPixel;
    return perPixel * image.width * image.height;
}

void traceAll(Renderer& renderer, LightMaps& maps, const scene::Scene& scene, Steps& steps) {
    std::uint64_t done = maps.load(renderer, scene);
    const std::uint64_t generations = maps.wanted(renderer);
    steps.report("photons", done, generations);
    for (; done < generations; ++done) {
        stopIfInterrupted();
        renderer.traceGeneration();
        steps.report("photons", done + 1, generations);
    }
}

ProgressiveStatistics traceProgressively(Renderer& renderer, const RenderOptions& options, const scene::Scene& scene,
                                         Clock::time_point start, Steps& steps) {
    const progressive::Goal goal{options.seconds, options.targetError, writingForecast(options, scene.image)};
    const auto reached = progressive::traceUntil(
        renderer, goal, [start] { return secondsSince(start); }, steps.reporter());
    if (reached.unfinished)
        logWarning(
            fmt::format("{:g} s were too short for a single generation: of {} photons some were on their way and "
                        "are given up, and the cloud is too dark; it is optically thick: lower cloud.0.extinction "
                        "or cloud.0.density_scale, or give it more time",
                        *options.seconds, reached.photonsEach));
    else if (reached.photonsEach > 0)
        logWarning(
            fmt::format("photons scatter very often in this scene: a generation has {} of them, so that it ends in "
                        "time",
                        reached.photonsEach));
    return {progressive::nameOf(reached.stop), reached.noise, reached.previewSeconds};
}

/// Prints the noise and time that were reached.
void tellReached(const RenderOptions& options, const Statistics& statistics, const ProgressiveStatistics& reached,
                 double seconds) {
    const std::string noise = reached.noise ? fmt::format("relMSE {:.2g} of noise", *reached.noise)
                                            : std::string("too few photons to tell their noise");
    if (!options.quiet)
        logNote(fmt::format("stopped by {} after {:.2f} s: {}, {} photons in {} generations{}", reached.stop, seconds,
                            noise, statistics.photons, statistics.generations,
                            options.error.used() ? "" : "; --error measures its bias"));
    if (options.seconds && seconds > *options.seconds && reached.stop == "seconds" && statistics.generations <= 2)
        logWarning(fmt::format("{:g} s were too short for this scene: it took {:.2f} s with {} photons",
                               *options.seconds, seconds, statistics.photons));
}

void writeOutputs(const RenderOptions& options, const LayeredImage& image, const scene::Image& how, Steps& steps) {
    steps.report("writing", 0, 1);
    writePictures(options.outputs, image, how);
    steps.report("writing", 1, 1);
}

}  // namespace

void runRender(const RenderOptions& options) {
    if (!options.frames.empty()) return runFrames(options);
    if (options.skipExisting)
        throw InputError("only frames can be skipped", "--skip-existing", "give --frames, or leave it out");
    const Clock::time_point start = Clock::now();
    requirePositive(options.seconds, "--seconds");
    requirePositive(options.targetError, "--target-error");
    requireSomeOutput(options);
    checkOutputs(options);
    scene::Scene scene = sceneOf(options);
    LightMaps maps(options.maps, scene);

    Steps steps(options.quiet);
    ErrorOfPicture error(options.error, options.quality, steps);
    RendererOptions how{options.device, options.validate, steps.reporter()};
    how.read = error.reader();
    how.progressive = progressive(options);
    std::size_t told = 0;  // warnings
    how.loaded = [&](std::span<const CloudSummary> clouds, std::span<const std::string> warnings) {
        tellClouds(clouds, warnings, options.quiet);
        told = warnings.size();
    };
    Renderer renderer(scene, how);
    std::optional<ProgressiveStatistics> reached;
    if (progressive(options))
        reached = traceProgressively(renderer, options, scene, start, steps);
    else
        traceAll(renderer, maps, scene, steps);
    stopIfInterrupted();
    maps.save(renderer, scene);
    LayeredImage image;
    if (!options.outputs.empty()) image = renderer.draw();
    stopIfInterrupted();
    const Statistics statistics = renderer.statistics();
    for (const std::string& warning : std::span(statistics.warnings).subspan(told)) logWarning(warning);

    if (!options.outputs.empty())
        error.measure(image, scene, statistics.clouds, secondsSince(start), options.seconds.has_value());
    noteOrigin(image, scene, statistics);

    const Clock::time_point writing = Clock::now();
    writeOutputs(options, image, scene.image, steps);
    const double writeSeconds = secondsSince(writing);
    const double seconds = secondsSince(start);
    if (reached) tellReached(options, statistics, *reached, seconds - error.seconds());
    error.tell(options.quiet);
    writeStatistics(options.stats, statisticsJson(statistics, reached, writeSeconds, seconds, &error));
    tellDefaults(scene, options.quiet);
    requireNoMessages(options.validate, statistics);
}

}  // namespace lumulus::cli
