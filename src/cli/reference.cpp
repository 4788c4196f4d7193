#include "cli/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/exr.h"
#include "base/frame_name.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/version.h"
#include "cli/clouds_told.h"
#include "cli/output.h"
#include "cli/stats_json.h"
#include "reference/film_file.h"
#include "reference/render.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"
#include "volume/far_parts.h"
#include "volume/load.h"
#include "volume/place_clouds.h"
#include "volume/summary.h"

namespace lumulus::cli {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

scene::Scene sceneOf(const ReferenceOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (options.seed) overrides.push_back("photon_map.seed=" + std::to_string(*options.seed));
    scene::Scene scene =
        scene::loadScene(options.scene, overrides, std::nullopt, static_cast<double>(options.frame.value_or(0)));
    scene::requireBoundedFog(scene);
    return divideFarParts(placeClouds(std::move(scene)));
}

void checkOptions(const ReferenceOptions& options) {
    if (options.spp.has_value() == options.seconds.has_value()) {
        throw InputError("the reference needs one limit", "command line", "give either --spp or --seconds");
    }
    // the range of the option lets NaN through
    if (options.seconds && std::isnan(*options.seconds)) {
        throw InputError("the time to stop is not a number", "--seconds", "give a number of seconds");
    }
    requireSuffix(options.output, {".exr"});
    std::vector<std::filesystem::path> places{options.output, reference::sumsBeside(options.output)};
    if (!options.stats.empty() && options.stats != "-") places.emplace_back(options.stats);
    checkPlaces(places);
}

reference::Renderer rendererOf(const ReferenceOptions& options, const scene::Scene& scene,
                               std::vector<CloudSummary>& summaries) {
    const auto majorant = options.localMajorant ? reference::Majorant::local : reference::Majorant::global;
    const CloudVolumes clouds = loadClouds(scene);
    summaries = summarise(scene, clouds);
    tellClouds(summaries, clouds.warnings, options.quiet);
    return {scene, clouds.placed(), majorant, scene.photonMap.seed,
            options.scatterings.value_or(reference::allScatterings)};
}

/// Continues the film of an earlier run, if there is one.
void resume(const ReferenceOptions& options, reference::Renderer& renderer) {
    const std::filesystem::path sums = reference::sumsBeside(options.output);
    // without any file a run with --resume begins anew; a picture without its sums is an error of readFilm
    if (std::filesystem::exists(sums) || std::filesystem::exists(options.output)) {
        renderer.resume(reference::readFilm(sums, renderer.fingerprint()));
    }
}

/// The text for --stats.
std::string statisticsOf(const reference::Film& film) {
    const nlohmann::ordered_json json{{"samples", film.samples}, {"seconds", film.seconds}, {"lost", film.lost}};
    return json.dump(2) + "\n";
}

/// Runs passes until the samples or the seconds are reached, or until Ctrl-C.
void renderPasses(const ReferenceOptions& options, reference::Renderer& renderer) {
    const Clock::time_point start = Clock::now();
    const auto rows = static_cast<std::uint64_t>(renderer.film().height);
    const std::uint64_t done = renderer.film().samples;
    const std::uint64_t wanted = options.spp.value_or(0);
    if (options.spp && done >= wanted) return;
    // progress counts rows, or milliseconds if the run is limited by time
    const auto total = options.spp ? (wanted - done) * rows : static_cast<std::uint64_t>(1e3 * *options.seconds);
    std::uint64_t shown = 0;
    Progress progress("reference", total, options.quiet);
    const auto advance = [&](std::uint64_t to) {
        to = std::min(to, total);
        if (to > shown) progress.advance(to - shown);
        shown = std::max(shown, to);
    };
    std::uint64_t rowsDone = 0;
    const auto goOn = [&](std::uint64_t more) {
        rowsDone += more;
        advance(options.spp ? rowsDone : static_cast<std::uint64_t>(1e3 * secondsSince(start)));
        return !interrupted();
    };
    const auto enough = [&] {
        return options.spp ? renderer.film().samples >= wanted : secondsSince(start) >= *options.seconds;
    };
    do {
        if (!renderer.pass(goOn)) break;
    } while (!enough());
    renderer.addSeconds(secondsSince(start));
}

void write(const ReferenceOptions& options, const scene::Scene& scene, const reference::Renderer& renderer,
           std::span<const CloudSummary> clouds) {
    const reference::Film& film = renderer.film();
    LayeredImage image = renderer.picture();
    noteReference(image, scene, film, options.localMajorant);
    noteGrids(image, clouds);
    if (options.scatterings) image.attributes["scatterings"] = std::to_string(*options.scatterings);
    // the sums come first: an interruption between the two files loses no work
    reference::writeFilm(reference::sumsBeside(options.output), film, renderer.fingerprint());
    writeExr(options.output, image);
}

}  // namespace

void noteReference(LayeredImage& image, const scene::Scene& scene, const reference::Film& film, bool localMajorant) {
    image.attributes["scene"] = scene.source;
    image.attributes["seed"] = std::to_string(scene.photonMap.seed);
    image.attributes["software"] = std::string("lumulus ") + version;
    image.attributes["device"] = "CPU";
    image.attributes["majorant"] = localMajorant ? "local" : "global";
    image.attributes["samples"] = std::to_string(film.samples);
    image.attributes["lost"] = std::to_string(film.lost);
}

void runReference(const ReferenceOptions& given) {
    ReferenceOptions options = given;
    if (options.frame && hasFrameNumber(options.output)) options.output = nameOfFrame(options.output, *options.frame);
    checkOptions(options);
    const scene::Scene scene = sceneOf(options);
    std::vector<CloudSummary> clouds;
    reference::Renderer renderer = rendererOf(options, scene, clouds);
    if (options.resume) resume(options, renderer);
    renderPasses(options, renderer);
    const std::uint64_t samples = renderer.film().samples;
    if (samples == 0) throw Error("interrupted before the first sample of every pixel", "", "nothing was written");
    write(options, scene, renderer, clouds);
    writeStatistics(options.stats, statisticsOf(renderer.film()));
    if (renderer.film().lost > 0)
        logWarning(fmt::format("{} paths were lost: they reached the limit of scattering events{}",
                               renderer.film().lost,
                               scene.fog.media.empty() ? "" : " (thinner fog, or lower layers, loses fewer)"));
    if (interrupted()) logWarning(fmt::format("interrupted: the picture has {} samples per pixel", samples));
    tellDefaults(scene, options.quiet);
}

}  // namespace lumulus::cli
