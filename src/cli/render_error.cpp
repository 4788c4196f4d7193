#include "cli/render_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtx/component_wise.hpp>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"

namespace lumulus::cli {
namespace {

double mebibytesOf(const CloudVolumes& clouds) {
    double mib = 0.0;
    for (const auto& volume : clouds.volumes)
        mib +=
            static_cast<double>(volume->size.x) * volume->size.y * volume->size.z * sizeof(float) / (1024.0 * 1024.0);
    return mib;
}

/// Refuses clouds whose voxels, all of them, would not fit the memory of the preparation: paths have no bricks.
void requireDense(const CloudVolumes& clouds, double budget) {
    const double mib = mebibytesOf(clouds);
    if (mib > budget)
        throw InputError(fmt::format("the paths that measure the error need {:.0f} MiB for all voxels of the clouds, "
                                     "and may have {:g}",
                                     mib, budget),
                         "preparation.memory_budget", "raise it, or leave out --error");
}

std::string percent(double share) {
    return fmt::format("{:+.2f} %", 100.0 * share);
}

/// Shows how far a part of the work is.
class Part {
  public:
    Part(Steps& steps, const char* name) : steps_(steps), name_(name) { steps_.report(name_, 0, parts); }
    ~Part() { steps_.report(name_, parts, parts); }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

    void operator()(double done) {
        stopIfInterrupted();
        const auto now = static_cast<std::uint64_t>(done * static_cast<double>(parts - 1));
        if (now > shown_) steps_.report(name_, shown_ = now, parts);
    }

  private:
    static constexpr std::uint64_t parts = 1000;
    Steps& steps_;
    const char* name_;
    std::uint64_t shown_ = 0;
};

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

nlohmann::ordered_json measuresJson(const reference::PictureError& error) {
    return {{"bias", error.bias},
            {"bias_sigma", error.biasSigma},
            {"relmse", error.relMse},
            {"relmse_sigma", error.relMseSigma},
            {"mean", error.mean}};
}

std::string inWords(const reference::PictureError& error) {
    return fmt::format("bias {} ± {:.2f} %, relMSE {:.2g} ± {:.1g}", percent(error.bias), 100.0 * error.biasSigma,
                       error.relMse, error.relMseSigma);
}

/// How often a path scatters at most, about: until it is absorbed, or through the thickest cloud.
double scatteringsOf(const scene::Scene& scene, std::span<const CloudSummary> clouds) {
    double most = 1.0;
    for (std::size_t i = 0; i < clouds.size(); ++i) {
        const double absorbed = 1.0 - glm::compMax(scene.clouds[i].albedo);
        most = std::max(most, std::min(clouds[i].largestThickness, 1.0 / std::max(absorbed, 1e-9)));
    }
    return most;
}

/// Light of lamps that thick fog scatters often is too dark near them and too bright far from them (docs/lamps.md).
bool hasLampsInFog(const scene::Scene& scene) {
    constexpr double thick = 1.0;  // optical depth between a lamp and the eye
    const double most = std::accumulate(
        scene.fog.media.begin(), scene.fog.media.end(), 0.0,
        [](double sum, const scene::FogMedium& medium) { return sum + glm::compMax(medium.scattering); });
    const glm::dvec3 eye = scene.camera.position.value_or(glm::dvec3(0.0));
    return std::ranges::any_of(scene.lamps, [&](const scene::Lamp& lamp) {
        return lamp.shines() && most * glm::distance(lamp.position, eye) > thick;
    });
}

}  // namespace

ErrorOfPicture::ErrorOfPicture(const ErrorOptions& options, std::optional<scene::Quality> quality, Steps& steps)
    : options_(options), quality_(quality.value_or(scene::Quality::interactive)), steps_(steps) {
    if (options.correct && options.uncorrected)
        throw InputError("a picture is corrected or it is not", "--no-correct", "leave it out, or --correct");
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

/// Unasked, a picture has so many paths in all and in a pixel, and about so many scattering events at most.
ErrorOfPicture::Plan ErrorOfPicture::planOf(const LayeredImage& image, const scene::Scene& scene,
                                            std::span<const CloudSummary> clouds, bool timed) const {
    if (options_.correct) return {true, options_.paths.value_or(0), 0, 0.0};
    if (options_.uncorrected || timed || quality_ == scene::Quality::draft ||
        !(std::ranges::any_of(clouds, &CloudSummary::inexact) || hasLampsInFog(scene)))
        return {};
    const bool best = quality_ == scene::Quality::final;
    const std::uint64_t least = (best ? 32 : 8) * image.pixels(), most = (best ? 1024 : 256) * image.pixels();
    const std::uint64_t paths = std::clamp<std::uint64_t>(best ? 8'000'000 : 1'000'000, least, most);
    // 0.01 in thick fog among lamps, 0.005 with the sun behind a cloud that scatters backwards
    // (docs/experiments/correction.md)
    const Plan plan{true, paths, 25 * paths, 0.002};
    // before paths are counted there is a round of two a pixel
    if (2.0 * static_cast<double>(image.pixels()) * scatteringsOf(scene, clouds) > static_cast<double>(plan.events))
        return {};
    return plan;
}

void ErrorOfPicture::measure(LayeredImage& image, const scene::Scene& scene, std::span<const CloudSummary> clouds,
                             double pictureSeconds, bool timed) {
    const Plan plan = planOf(image, scene, clouds, timed);
    if (!options_.used() && !plan.correct) return;
    if (clouds_.clouds.size() != scene.clouds.size()) clouds_ = loadClouds(scene, steps_.reporter());
    if (!options_.used() && mebibytesOf(clouds_) > scene.preparation.memoryBudget) return;  // the warning remains
    const reference::PixelPaths paths(scene, clouds_.placed());
    // measuring and correcting share the time
    const bool both = options_.used() && plan.correct;
    const double seconds = options_.seconds.value_or(pictureSeconds) * (both ? 0.5 : 1.0);
    std::optional<reference::ErrorProbes> probes;
    if (options_.used()) {
        Part part(steps_, "error");
        probes = reference::ErrorProbes::trace(
            image, paths, {scene.photonMap.seed, seconds, options_.paths.value_or(0)}, std::ref(part));
        nothingToSee_ = !probes;
        if (probes) error_ = probes->errorOf(image);
    }
    if (plan.correct) {
        Part part(steps_, "correction");
        correction_ = reference::correct(
            image, paths, {scene.photonMap.seed, seconds, plan.paths, plan.events, plan.leastEvenness}, std::ref(part));
        // their paths have nothing in common
        if (correction_ && probes) {
            before_ = error_;
            error_ = probes->errorOf(image);
        }
    }
    if (error_) reference::addErrorLayers(image, *error_);
    note(image);
}

void ErrorOfPicture::note(LayeredImage& image) const {
    const auto text = [](double value) { return fmt::format("{:.6g}", value); };
    if (error_) {
        image.attributes["error.bias"] = text(error_->bias);
        image.attributes["error.bias_sigma"] = text(error_->biasSigma);
        image.attributes["error.relmse"] = text(error_->relMse);
        image.attributes["error.relmse_sigma"] = text(error_->relMseSigma);
        image.attributes["error.paths"] = std::to_string(error_->paths);
    }
    if (correction_ && correction_->made)
        image.attributes["error.corrected"] =
            fmt::format("R, G, B and cloud.* are corrected by {} unbiased paths{}", correction_->paths,
                        before_ ? "; before: " + inWords(*before_) : "");
}

double ErrorOfPicture::seconds() const {
    return (error_ ? error_->seconds : 0.0) + (correction_ ? correction_->seconds : 0.0);
}

void ErrorOfPicture::addTo(nlohmann::ordered_json& statistics) const {
    if (error_) {
        nlohmann::ordered_json& error = statistics["error"] = measuresJson(*error_);
        error["pixels"] = error_->pixels;
        error["paths"] = error_->paths;
        error["lost"] = error_->lost;
        error["seconds"] = error_->seconds;
        error["corrected"] = correction_ && correction_->made;
        if (before_) error["before"] = measuresJson(*before_);
        error["blocks"] = blocksJson(*error_);
    }
    if (correction_)
        statistics["correction"] = {{"made", correction_->made},   {"pixels", correction_->pixels},
                                    {"paths", correction_->paths}, {"events", correction_->events},
                                    {"lost", correction_->lost},   {"seconds", correction_->seconds}};
}

void ErrorOfPicture::tellLost() const {
    const std::uint64_t lost = (error_ ? error_->lost : 0) + (correction_ ? correction_->lost : 0);
    const std::uint64_t paths = (error_ ? error_->paths : 0) + (correction_ ? correction_->paths : 0);
    if (lost > 0)
        logWarning(
            fmt::format("{} of the {} paths that measure the error reached the limit of scattering events: what "
                        "they lack counts as error",
                        lost, paths));
}

void ErrorOfPicture::tell(bool quiet) const {
    if (nothingToSee_) return logWarning("no pixel shows a cloud or fog: the picture has no error to measure");
    tellLost();
    if (quiet) return;
    if (correction_ && !correction_->made)
        logNote(fmt::format("not corrected: few of {} paths carry most of the light, so that they may lack much of it",
                            correction_->paths));
    else if (correction_)
        logNote(fmt::format("corrected by {} paths ({} a pixel) in {:.2f} s{}", correction_->paths,
                            correction_->paths / correction_->pixels, correction_->seconds,
                            before_ ? "; before: " + inWords(*before_) : ""));
    if (error_)
        logNote(fmt::format("measured by {} paths in {:.2f} s: {} (one sigma)", error_->paths, error_->seconds,
                            inWords(*error_)));
}

}  // namespace lumulus::cli
