#include "cli/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/exr.h"
#include "base/png.h"
#include "base/text.h"
#include "base/tonemap.h"
#include "cli/output.h"
#include "reference/difference_picture.h"
#include "reference/flip.h"
#include "reference/metrics.h"

namespace lumulus::cli {
namespace {

using reference::Comparison;
using reference::Measure;

struct Row {
    const char* key;
    const char* title;
    const Measure& measure;
};

std::vector<Row> rowsOf(const Comparison& c) {
    return {{"rmse", "RMSE", c.rmse},
            {"relmse", "relMSE", c.relMse},
            {"bias", "bias", c.bias},
            {"relative_bias", "bias, relative", c.relativeBias},
            {"mape", "MAPE", c.mape}};
}

std::string asText(const Comparison& c, double flip, std::size_t pixels) {
    std::string text = fmt::format("{:<16}{} of {}\n", "pixels", c.pixels, pixels);
    for (const Row& row : rowsOf(c)) {
        text += fmt::format("{:<16}{:.6g}", row.title, row.measure.value);
        text += row.measure.standardError ? fmt::format(" ± {:.2g}\n", *row.measure.standardError) : "\n";
    }
    text += fmt::format("{:<16}{:.6g}\n", "FLIP", flip);
    if (c.imageNoise) text += fmt::format("{:<16}{:.6g}\n", "image noise", *c.imageNoise);
    if (c.referenceNoise) text += fmt::format("{:<16}{:.6g}\n", "reference noise", *c.referenceNoise);
    return text;
}

std::string asJson(const Comparison& c, double flip) {
    const auto optional = [](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json{{"pixels", c.pixels}};
    nlohmann::ordered_json errors = nlohmann::ordered_json::object();
    for (const Row& row : rowsOf(c)) {
        json[row.key] = row.measure.value;
        errors[row.key] = optional(row.measure.standardError);
    }
    json["flip"] = flip;
    json["standard_error"] = errors;
    json["image_noise"] = optional(c.imageNoise);
    json["reference_noise"] = optional(c.referenceNoise);
    json["mean_reference"] = c.meanReference;
    return json.dump() + "\n";
}

double flipOf(const LayeredImage& image, const LayeredImage& truth, double exposure) {
    return reference::flipMean(
        reference::flip(toneMap(image, exposure), toneMap(truth, exposure), image.width, image.height));
}

/// The difference I − R, channel by channel.
LayeredImage difference(const LayeredImage& image, const LayeredImage& reference) {
    LayeredImage result;
    result.width = image.width;
    result.height = image.height;
    for (const char* name : {"R", "G", "B"}) {
        std::vector<float>& layer = result.layer(name);
        for (std::size_t i = 0; i < layer.size(); ++i)
            layer[i] = image.layers.at(name)[i] - reference.layers.at(name)[i];
    }
    return result;
}

void writeDifference(const std::filesystem::path& path, const LayeredImage& image, const LayeredImage& reference) {
    if (hasSuffix(path, ".exr")) {
        writeExr(path, difference(image, reference));
    } else {
        writePng(path, image.width, image.height, reference::differencePicture(image, reference));
    }
}

/// The mean of both references, for measures that need one picture.
LayeredImage meanOf(LayeredImage a, const LayeredImage& b) {
    for (const char* name : {"R", "G", "B"}) {
        std::vector<float>& layer = a.layers.at(name);
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = 0.5F * (layer[i] + b.layers.at(name)[i]);
    }
    return a;
}

/// A picture that is compared with others of its size. Errors: InputError where it does not fit `image`.
LayeredImage readComparable(const std::filesystem::path& path, const reference::NamedImage& image) {
    LayeredImage other = readExr(path);
    reference::requireComparable(image, {other, path.string()});
    return other;
}

/// Prints the error that a picture states in its header.
void tellOwnError(const CompareOptions& options) {
    if (!options.reference.empty())
        throw InputError("--self needs no reference", options.reference.string(), "leave one of them out");
    const LayeredImage image = readExr(options.image);
    const std::string prefix = "error.";
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    std::string text;
    for (const auto& [name, value] : image.attributes) {
        if (!name.starts_with(prefix)) continue;
        const std::string key = name.substr(prefix.size());
        const auto number = nlohmann::ordered_json::parse(value, nullptr, false);
        json[oneLine(key)] = number.is_number() ? number : nlohmann::ordered_json(oneLine(value));
        text += fmt::format("{:<16}{}\n", oneLine(key), oneLine(value));
    }
    if (text.empty())
        throw InputError("the picture states no error of its own", options.image.string(),
                         "render it with --error, or give a reference");
    printOut(options.json ? json.dump() + "\n" : text);
}

}  // namespace

std::string comparisonJson(const LayeredImage& image, const LayeredImage& truth, double exposure) {
    reference::requireComparable({image, "image"}, {truth, "reference"});
    return asJson(reference::compare(image, truth), flipOf(image, truth, exposure));
}

void runCompare(const CompareOptions& options) {
    if (options.self) return tellOwnError(options);
    if (options.reference.empty())
        throw InputError("there is nothing to compare the picture with", "reference",
                         "give a reference, or --self for the error that the picture states itself");
    // the range of the option lets NaN through
    if (std::isnan(options.exposure)) {
        throw InputError("the exposure is not a number", "--exposure", "give a number of stops");
    }
    if (!options.diff.empty()) {
        requireSuffix(options.diff, {".png", ".exr"});
        checkWritable(options.diff);
    }
    const LayeredImage image = readExr(options.image);
    const reference::NamedImage named{image, options.image.string()};
    LayeredImage truth = readComparable(options.reference, named);
    std::optional<LayeredImage> chosen;
    if (!options.denominator.empty()) chosen = readComparable(options.denominator, named);
    const LayeredImage* denominator = chosen ? &*chosen : nullptr;
    Comparison comparison;
    if (options.secondReference.empty()) {
        comparison = reference::compare(image, truth, denominator);
    } else {
        const LayeredImage second = readComparable(options.secondReference, named);
        comparison = reference::compare(image, truth, second, denominator);
        truth = meanOf(std::move(truth), second);
    }
    const double flip = flipOf(image, truth, options.exposure);
    printOut(options.json ? asJson(comparison, flip) : asText(comparison, flip, image.pixels()));
    if (!options.diff.empty()) writeDifference(options.diff, image, truth);
}

}  // namespace lumulus::cli
