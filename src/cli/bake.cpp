#include "cli/bake.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <utility>

#include "bake/light_file.h"
#include "bake/light_grid.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/clouds_told.h"
#include "cli/options.h"
#include "cli/output.h"
#include "progressive/trace_until.h"
#include "render/renderer.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"
#include "volume/place_clouds.h"

namespace lumulus::cli {
namespace {

/// The scene with a photon map that holds all light but that of the sun, in the bands that are written, and clouds of
/// one resolution whatever the camera sees.
scene::Scene sceneOf(const BakeOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (options.seed) overrides.push_back("photon_map.seed=" + std::to_string(*options.seed));
    scene::Scene scene =
        scene::loadScene(options.scene, overrides, options.quality, static_cast<double>(options.frame.value_or(0)));
    scene::requireBoundedFog(scene);
    scene.photonMap.forwardCut = 0.0;
    scene.photonMap.bands = 3;
    scene.photonMap.directionsGiven = true;
    scene.preparation.levelOfDetail = false;
    return placeClouds(std::move(scene));
}

void checkOptions(const BakeOptions& options, const bake::LightPlaces& places) {
    if (options.voxel && !(*options.voxel > 0.0 && std::isfinite(*options.voxel)))
        throw InputError(fmt::format("{} m is no edge of a voxel", *options.voxel), "--voxel", "give a number above 0");
    requireSuffix(options.output, {".vdb"});
    std::vector<std::filesystem::path> outputs{places.vdb, places.conventions};
    if (!places.nano.empty()) outputs.push_back(places.nano);
    checkPlaces(outputs);
}

}  // namespace

void runBake(const BakeOptions& options) {
    const bake::LightPlaces places = bake::placesOf(options.output, options.nano);
    checkOptions(options, places);
    const scene::Scene scene = sceneOf(options);
    Steps steps(options.quiet);
    RendererOptions how{options.device, false, steps.reporter()};
    std::size_t told = 0;  // warnings
    how.loaded = [&](std::span<const CloudSummary> clouds, std::span<const std::string> warnings) {
        tellClouds(clouds, warnings, options.quiet);
        told = warnings.size();
    };
    Renderer renderer(scene, how);
    bake::checkVoxels(renderer, options.voxel);
    progressive::traceAll(renderer, steps.reporter());
    const bake::LightGrid grid = bake::bakeLight(renderer, options.voxel, steps.reporter(), stopIfInterrupted);
    const Statistics statistics = renderer.statistics();
    for (const std::string& warning : std::span(statistics.warnings).subspan(told)) logWarning(warning);
    bake::writeLight(places, grid, scene, steps.reporter(), stopIfInterrupted);
    if (!options.quiet)
        logNote(fmt::format("{} voxels of {:.4g} m with light, of {} photons", grid.places.size(), grid.voxel,
                            statistics.photons));
    tellDefaults(scene, options.quiet);
}

void addBake(CLI::App& app, BakeOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("bake", "Write the light in the clouds of a scene as OpenVDB grids");
    command->add_option("scene", options.scene, sceneHelp)->required();
    command
        ->add_option("-o,--output", options.output,
                     "OpenVDB file (.vdb); its conventions stand beside it in a file .json")
        ->required();
    command->add_flag("--nvdb", options.nano, "Write a NanoVDB file (.nvdb) too");
    command
        ->add_option("--voxel", options.voxel, "Edge of a voxel, metres (default: a 96th of the clouds' longest side)")
        ->check(notEmpty());
    addQuality(*command, options.quality);
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    command->add_option("--seed", options.seed, "Seed of the random numbers (photon_map.seed)")->check(seedRange());
    addDevice(*command, options.device);
    command->add_flag("--quiet", options.quiet, "No progress");
    command->footer("Example:\n  lumulus bake configs/scenes/cumulus.toml -o light.vdb --voxel 12.5");
    command->callback([&options, &action] { action = [&options] { runBake(options); }; });
}

}  // namespace lumulus::cli
