#include "cli/bench.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/exr.h"
#include "base/progress.h"
#include "bench/measure.h"
#include "bench/path_tracer_runs.h"
#include "bench/peer.h"
#include "bench/plan.h"
#include "bench/plot.h"
#include "bench/record.h"
#include "bench/render_runs.h"
#include "bench/table.h"
#include "cli/output.h"
#include "gpu/device.h"
#include "scene/load.h"
#include "volume/far_parts.h"
#include "volume/place_clouds.h"

namespace lumulus::cli {
namespace {

void makeFolder(const std::filesystem::path& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (!std::filesystem::is_directory(folder)) {
        throw InputError("cannot make the folder", folder.string(), "give -o a folder that can be written to");
    }
}

/// The seed in the reference's attributes.
std::optional<std::uint64_t> seedOf(const LayeredImage& reference) {
    const auto found = reference.attributes.find("seed");
    if (found == reference.attributes.end()) return {};
    const std::string& text = found->second;
    std::uint64_t seed = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (end.ec != std::errc()) return {};
    return seed;
}

}  // namespace

void runBench(const BenchOptions& options) {
    const std::vector<double> budgets = bench::orderedBudgets(options.seconds);
    const scene::Scene scene = divideFarParts(placeClouds(scene::loadScene(
        options.scene, options.overrides, std::nullopt, static_cast<double>(options.frame.value_or(0)))));
    LayeredImage picture = readExr(options.reference);
    const std::vector<std::uint64_t> seeds = bench::seedsWithout(scene.photonMap.seed, options.seeds, seedOf(picture));
    const bench::Truth truth = bench::makeTruth(std::move(picture), options.reference.string(), scene.image.width,
                                                scene.image.height, scene.image.exposure);
    const std::vector<bench::Row> peer =
        options.cycles.empty() ? std::vector<bench::Row>() : bench::readPeer(options.cycles);
    gpu::chooseDevices(gpu::listDevices(), options.device);  // refuses an unknown device before any work
    makeFolder(options.output);
    for (const char* name : {"error.csv", "error.svg", "error.png"}) checkWritable(options.output / name);

    const std::uint64_t pictures = budgets.size() * seeds.size();
    std::vector<bench::Run> runs;
    {
        Progress progress("render", pictures, options.quiet);
        runs = bench::renderRuns(scene, options.device, truth, budgets, seeds, progress);
    }
    {
        Progress progress("path tracer", pictures, options.quiet);
        const std::vector<bench::Run> traced = bench::pathTracerRuns(scene, truth, budgets, seeds, progress);
        runs.insert(runs.end(), traced.begin(), traced.end());
    }
    std::vector<bench::Row> rows = bench::summarise(runs);
    rows.insert(rows.end(), peer.begin(), peer.end());
    const std::string numbers = bench::csv(rows);
    writeFile(options.output / "error.csv", std::as_bytes(std::span(numbers)));
    const bench::Plot plot = bench::errorPlot(rows, options.scene.filename().string(), truth.floor);
    writeFile(options.output / "error.svg", plot.svg);
    writeFile(options.output / "error.png", plot.png);
    printOut(bench::tableText(rows, truth.floor));
}

}  // namespace lumulus::cli
