#include "cli/render_error.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"

namespace lumulus::cli {
namespace {

/// Refuses clouds whose voxels, all of them, would not fit the memory of the preparation: paths have no bricks.
void requireDense(const CloudVolumes& clouds, double budget) {
    double mib = 0.0;
    for (const auto& volume : clouds.volumes)
        mib +=
            static_cast<double>(volume->size.x) * volume->size.y * volume->size.z * sizeof(float) / (1024.0 * 1024.0);
    if (mib > budget)
        throw InputError(fmt::format("the paths that measure the error need {:.0f} MiB for all voxels of the clouds, "
                                     "and may have {:g}",
                                     mib, budget),
                         "preparation.memory_budget", "raise it, or leave out --error");
}

std::string percent(double share) {
    return fmt::format("{:+.2f} %", 100.0 * share);
}

void note(LayeredImage& image, const reference::PictureError& error, bool corrected) {
    const auto text = [](double value) { return fmt::format("{:.6g}", value); };
    image.attributes["error.bias"] = text(error.bias);
    image.attributes["error.bias_sigma"] = text(error.biasSigma);
    image.attributes["error.relmse"] = text(error.relMse);
    image.attributes["error.relmse_sigma"] = text(error.relMseSigma);
    image.attributes["error.paths"] = std::to_string(error.paths);
    if (corrected)
        image.attributes["error.corrected"] =
            "R, G, B and cloud.* are corrected: their mean over clouds and fog is unbiased within error.bias_sigma; "
            "error.bias, error.relmse and the layer error.bias are of the picture before";
}

nlohmann::ordered_json blocksJson(const reference::PictureError& error) {
    nlohmann::ordered_json blocks = nlohmann::ordered_json::array();
    for (const reference::ErrorBlock& block : error.blocks)
        blocks.push_back({{"x", block.x},
                          {"y", block.y},
                          {"width", block.width},
                          {"height", block.height},
                          {"pixels", block.pixels},
                          {"bias", block.bias()},
                          {"bias_sigma", block.biasSigma()}});
    return blocks;
}

}  // namespace

ErrorOfPicture::ErrorOfPicture(const ErrorOptions& options, Steps& steps) : options_(options), steps_(steps) {
    if (options.seconds && options.paths)
        throw InputError("the paths that measure the error need one limit", "--error-paths",
                         "give it, or --error-seconds");
    if (options.seconds && !(*options.seconds > 0.0 && std::isfinite(*options.seconds)))
        throw InputError(fmt::format("{} is no limit", *options.seconds), "--error-seconds", "give a number above 0");
}

ReadClouds ErrorOfPicture::reader() {
    if (!options_.used()) return {};
    return [this](const scene::Scene& scene) {
        CloudVolumes clouds = loadClouds(scene, steps_.reporter(), stopIfInterrupted, FieldStorage::asWanted);
        if (clouds.isSparse())
            requireDense(clouds, scene.preparation.memoryBudget);
        else
            clouds_ = clouds;  // the same voxels
        return clouds;
    };
}

void ErrorOfPicture::measure(LayeredImage& image, const scene::Scene& scene, double pictureSeconds) {
    if (!options_.used()) return;
    if (clouds_.clouds.size() != scene.clouds.size()) clouds_ = loadClouds(scene, steps_.reporter());
    constexpr std::uint64_t parts = 1000;
    std::uint64_t shown = 0;
    steps_.report("error", 0, parts);
    const reference::ErrorOrder order{scene.photonMap.seed, options_.seconds.value_or(pictureSeconds),
                                      options_.paths.value_or(0)};
    error_ = reference::measureError(image, scene, clouds_.placed(), order, [&](double done) {
        stopIfInterrupted();
        const auto now = static_cast<std::uint64_t>(done * static_cast<double>(parts - 1));
        if (now > shown) steps_.report("error", shown = now, parts);
    });
    steps_.report("error", parts, parts);
    if (!error_) return;
    reference::addErrorLayers(image, *error_);
    if (options_.correct) reference::correct(image, *error_);
    note(image, *error_, options_.correct);
}

nlohmann::ordered_json ErrorOfPicture::json() const {
    if (!error_) return nullptr;
    return {{"bias", error_->bias},         {"bias_sigma", error_->biasSigma},
            {"relmse", error_->relMse},     {"relmse_sigma", error_->relMseSigma},
            {"mean", error_->mean},         {"pixels", error_->pixels},
            {"paths", error_->paths},       {"lost", error_->lost},
            {"seconds", error_->seconds},   {"corrected", options_.correct},
            {"blocks", blocksJson(*error_)}};
}

void ErrorOfPicture::tell(bool quiet) const {
    if (!options_.used()) return;
    if (!error_) return logWarning("no pixel shows a cloud or fog: the picture has no error to measure");
    if (error_->lost > 0)
        logWarning(
            fmt::format("{} of the {} paths that measure the error reached the limit of scattering events: what "
                        "they lack counts as error",
                        error_->lost, error_->paths));
    if (quiet) return;
    logNote(fmt::format(
        "measured by {} paths in {:.2f} s: bias {} ± {:.2f} %, relMSE {:.2g} ± {:.1g} (one sigma){}", error_->paths,
        error_->seconds, percent(error_->bias), 100.0 * error_->biasSigma, error_->relMse, error_->relMseSigma,
        options_.correct
            ? fmt::format("; corrected: the mean has no bias now, within {:.2f} %", 100.0 * error_->biasSigma)
            : ""));
}

}  // namespace lumulus::cli
