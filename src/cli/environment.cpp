#include "cli/environment.h"

#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/clouds_told.h"
#include "cli/options.h"
#include "cli/output.h"
#include "environment/environment_files.h"
#include "environment/surroundings.h"
#include "progressive/trace_until.h"
#include "render/renderer.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"
#include "sky/sky_report.h"
#include "volume/place_clouds.h"

namespace lumulus::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int mostPixels = 2048;  // along an edge

int sizeOf(const EnvironmentOptions& options) {
    constexpr int usual = 256, ofThesis = 1024;
    const int size = options.size.value_or(options.method == "thesis" ? ofThesis : usual);
    if (size < 1 || size > mostPixels || !std::has_single_bit(static_cast<unsigned>(size)))
        throw InputError(fmt::format("faces cannot have {} pixels", size), "--size", "give a power of two, 1 to 2048");
    return size;
}

environment::FileOptions filesOf(const EnvironmentOptions& options) {
    using enum environment::Method;
    requireSuffix(options.output, {".exr"});
    const int size = sizeOf(options);
    environment::FileOptions files{
        options.output, options.method == "thesis" ? thesis : sampling, {}, options.byLevel, options.byFace};
    if (files.method == thesis && (options.levels || !options.roughness.empty()))
        throw InputError("the thesis has eleven levels of its own", options.levels ? "--levels" : "--roughness",
                         "leave it out, or leave out --method thesis");
    if (options.levels && !options.roughness.empty())
        throw InputError("the number of levels is given twice", "--levels", "leave out --levels or --roughness");
    files.levels = environment::levelsOf(files.method, size, options.levels.value_or(environment::defaultLevels(size)),
                                         options.roughness);
    if (options.seconds && !(*options.seconds > 0.0 && std::isfinite(*options.seconds)))
        throw InputError(fmt::format("{} is no limit", *options.seconds), "--seconds", "give a number above 0");
    checkPlaces(environment::namesOf(files));
    return files;
}

scene::Scene sceneOf(const EnvironmentOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (options.seed) overrides.push_back("photon_map.seed=" + std::to_string(*options.seed));
    scene::Scene scene =
        scene::loadScene(options.scene, overrides, options.quality, static_cast<double>(options.frame.value_or(0)));
    scene::requireBoundedFog(scene);
    const bool given = !options.at.empty();
    const glm::dvec3 point = given ? glm::dvec3(options.at[0], options.at[1], options.at[2]) : sky::observerOf(scene);
    return placeClouds(
        environment::sceneAround(std::move(scene), point, sizeOf(options), given ? "--at" : "camera.position"));
}

void trace(Renderer& renderer, const EnvironmentOptions& options, Clock::time_point start, Steps& steps) {
    if (options.seconds) {
        // filtering 256 pixels an edge takes a core about three seconds
        const double filtering = 3.0 * std::pow(sizeOf(options) / 256.0, 2);
        const auto elapsed = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
        const progressive::Reached reached =
            progressive::traceUntil(renderer, {options.seconds, {}, filtering}, elapsed, steps.reporter());
        if (reached.unfinished)
            logWarning(fmt::format("{:g} s were too short for a single generation of photons, and clouds are too dark",
                                   *options.seconds));
        return;
    }
    progressive::traceAll(renderer, steps.reporter());
}

}  // namespace

void runEnvironment(const EnvironmentOptions& options) {
    const Clock::time_point start = Clock::now();
    const environment::FileOptions files = filesOf(options);
    const scene::Scene scene = sceneOf(options);
    Steps steps(options.quiet);
    RendererOptions how{options.device, false, steps.reporter()};
    how.progressive = options.seconds.has_value();
    std::size_t told = 0;  // warnings
    how.loaded = [&](std::span<const CloudSummary> clouds, std::span<const std::string> warnings) {
        tellClouds(clouds, warnings, options.quiet);
        told = warnings.size();
    };
    Renderer renderer(scene, how);
    trace(renderer, options, start, steps);
    stopIfInterrupted();
    const environment::Surroundings surroundings =
        environment::drawSurroundings(renderer, scene, options.withSun, stopIfInterrupted);
    const std::vector<std::string> warnings = renderer.statistics().warnings;
    for (const std::string& warning : std::span(warnings).subspan(told)) logWarning(warning);
    const auto contents = environment::filesOf(surroundings, scene, files, steps.reporter(), stopIfInterrupted);
    stopIfInterrupted();
    steps.report("writing", 0, 1);
    for (const environment::File& file : contents) writeFile(file.path, file.bytes);
    steps.report("writing", 1, 1);
    tellDefaults(scene, options.quiet);
}

void addEnvironment(CLI::App& app, EnvironmentOptions& options, Action& action) {
    CLI::App* command =
        app.add_subcommand("environment", "Write the light around a point as prefiltered environment maps");
    command->add_option("scene", options.scene, sceneHelp)->required();
    command
        ->add_option("-o,--output", options.output,
                     "Cube map (.exr) with a mip level for each roughness; env.exr has env.json, env_latlong.exr and "
                     "env_brdf.exr beside it")
        ->required();
    command
        ->add_option("--at", options.at,
                     "Point that the light arrives at: X,Y,Z, metres (default: the camera, or 2 m above the ground at "
                     "the origin)")
        ->delimiter(',')
        ->expected(3);
    command->add_option("--levels", options.levels,
                        "Levels, with roughness 0 to 1 in equal steps (default: 5, which leave 16 pixels of 256)");
    command->add_option("--roughness", options.roughness, "Roughness of each level instead, rising: 0,0.1,0.3,1")
        ->delimiter(',')
        ->allow_extra_args(false);
    command->add_option("--size", options.size, "Pixels along an edge of the finest faces, a power of two (256)");
    command
        ->add_option("--method", options.method,
                     "sampling: GGX; thesis: eleven levels of means over cones (Moschos 2017)")
        ->check(CLI::IsMember({"sampling", "thesis"}))
        ->capture_default_str();
    command->add_flag("--by-level", options.byLevel, "Write each level as latitude-longitude too: env_m0.exr, ...");
    command->add_flag("--by-face", options.byFace, "Write each face of each level too: env_m0_px.exr, ...");
    command->add_flag("--with-sun", options.withSun, "Leave the discs of sun and moon in the maps");
    addQuality(*command, options.quality);
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    command->add_option("--seed", options.seed, "Seed of the random numbers (photon_map.seed)")->check(seedRange());
    command->add_option("--seconds", options.seconds, "Trace photons so that the whole run takes this many seconds")
        ->check(notEmpty());
    addDevice(*command, options.device);
    command->add_flag("--quiet", options.quiet, "No progress");
    command->footer("Example:\n  lumulus environment configs/scenes/field-morning.toml -o env.exr --levels 5");
    command->callback([&options, &action] { action = [&options] { runEnvironment(options); }; });
}

}  // namespace lumulus::cli
