#include "cli/exr_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/text.h"

namespace lumulus::cli {
namespace {

/// Channels of a part whose names differ in their last word only.
struct Layer {
    std::size_t part = 0;
    std::string name;                             ///< with the part's name before it, where the file has several parts
    std::map<std::string, std::string> channels;  ///< last word in upper case → whole name
};

std::string lowered(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

/// RED is as good as R.
std::string channelWord(std::string_view word) {
    const std::string low = lowered(word);
    if (low == "red") return "R";
    if (low == "green") return "G";
    if (low == "blue") return "B";
    std::string result(word);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return result;
}

std::string_view lastWord(std::string_view name) {
    return name.substr(name.rfind('.') + 1);  // npos + 1 is 0
}

/// The part's name stands before the layer's, unless the layer's begins with it already.
std::string nameOf(const ExrPart& part, const std::string& layer, bool several) {
    if (!several || part.name.empty() || layer == part.name || layer.starts_with(part.name + ".")) return layer;
    return layer.empty() ? part.name : part.name + "." + layer;
}

std::vector<Layer> layersOf(const std::vector<ExrPart>& parts) {
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        std::map<std::string, Layer> found;
        for (const std::string& channel : parts[i].channels) {
            const std::size_t dot = channel.rfind('.');
            const std::string prefix = dot == std::string::npos ? "" : channel.substr(0, dot);
            Layer& layer = found[prefix];
            layer.part = i;
            layer.name = nameOf(parts[i], prefix, parts.size() > 1);
            layer.channels.emplace(channelWord(lastWord(channel)), channel);
        }
        for (auto& one : found) layers.push_back(std::move(one.second));
    }
    return layers;
}

bool hasColour(const Layer& layer) {
    return std::ranges::all_of(std::array{"R", "G", "B"},
                               [&](const char* name) { return layer.channels.contains(name); });
}

/// The first of R, G and B that no layer has, or all three where each is in some layer.
std::string missingColour(const std::vector<ExrPart>& parts) {
    const std::vector<Layer> layers = layersOf(parts);
    for (const char* name : {"R", "G", "B"})
        if (std::ranges::none_of(layers, [&](const Layer& layer) { return layer.channels.contains(name); }))
            return name;
    return "with R, G and B";
}

/// All channels, with the names of their parts.
std::string channelNames(const std::vector<ExrPart>& parts) {
    std::vector<std::string> names;
    for (const ExrPart& part : parts)
        for (const std::string& channel : part.channels) names.push_back(nameOf(part, channel, parts.size() > 1));
    return shortened(fmt::format("{}", fmt::join(names, ", ")), 300);
}

std::string layerNames(const std::vector<Layer>& layers) {
    std::vector<std::string> names;
    for (const Layer& layer : layers) names.push_back(layer.name.empty() ? "R, G, B alone" : layer.name);
    return shortened(fmt::format("{}", fmt::join(names, ", ")), 300);
}

/// Whether `wanted` is one or several neighbouring words of a layer's name.
bool matches(const std::string& name, const std::string& wanted) {
    return ("." + name + ".").find("." + wanted + ".") != std::string::npos;
}

/// The layer that a person means by a picture, of several; null if it is not clear.
const Layer* pictureOf(const std::vector<Layer>& layers, const std::string& wanted) {
    static const std::set<std::string> usual{"combined", "beauty", "rgba", "rgb", "color", "colour"};
    const auto first = [&](const auto& holds) {
        const auto it = std::ranges::find_if(layers, holds);
        return it == layers.end() ? nullptr : &*it;
    };
    const auto only = [&](const auto& holds) {
        return std::ranges::count_if(layers, holds) == 1 ? first(holds) : nullptr;
    };
    if (const Layer* exact = first([&](const Layer& layer) { return layer.name == wanted; })) return exact;
    // in a file of several parts the first of them that has plain R, G, B
    const auto plain = [](const Layer& layer) { return layer.channels.at("R").find('.') == std::string::npos; };
    if (const Layer* found = first(plain); found != nullptr && wanted.empty()) return found;
    if (const Layer* found = only([&](const Layer& l) { return usual.contains(lowered(lastWord(l.name))); }))
        return found;
    return layers.size() == 1 ? &layers.front() : nullptr;
}

/// Length of the beginning that two names share.
std::size_t sharedLength(const std::string& a, const std::string& b) {
    return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

struct DepthCandidate {
    DepthChannel channel;
    std::string layer;
    int rank = 0;  ///< the smallest is the best
};

std::optional<DepthCandidate> depthIn(const Layer& layer) {
    const std::string word = lowered(lastWord(layer.name));
    const bool called = word.find("depth") != std::string::npos || word == "z";
    const auto z = layer.channels.find("Z"), v = layer.channels.find("V");
    if (z != layer.channels.end()) {
        const bool coordinate = layer.channels.contains("X") || layer.channels.contains("Y");
        const int rank = z->second == "Z" ? 0 : z->second == "depth.Z" ? 1 : 2;
        if (rank < 2 || (called && !coordinate)) return DepthCandidate{{layer.part, z->second}, layer.name, rank};
    } else if (called && v != layer.channels.end()) {
        return DepthCandidate{{layer.part, v->second}, layer.name, 2};
    }
    return std::nullopt;
}

}  // namespace

ColourChannels findColour(const std::vector<ExrPart>& parts, const std::string& wanted,
                          const std::filesystem::path& path) {
    std::vector<Layer> layers = layersOf(parts);
    std::erase_if(layers, [](const Layer& layer) { return !hasColour(layer); });
    if (layers.empty())
        throw InputError(
            fmt::format("the picture has no layer {} (it has {})", missingColour(parts), channelNames(parts)),
            path.string(), "give one with R, G and B");
    std::vector<Layer> fitting = layers;
    if (!wanted.empty()) std::erase_if(fitting, [&](const Layer& layer) { return !matches(layer.name, wanted); });
    if (fitting.empty())
        throw InputError(fmt::format("the picture has no layer \"{}\" with R, G and B", wanted), path.string(),
                         fmt::format("choose from {}", layerNames(layers)));
    const Layer* chosen = pictureOf(fitting, wanted);
    if (chosen == nullptr)
        throw InputError("several layers have R, G and B", path.string(),
                         fmt::format("choose one by --layer: {}", layerNames(fitting)));
    const auto& channels = chosen->channels;
    ColourChannels found{chosen->part, chosen->name, {channels.at("R"), channels.at("G"), channels.at("B")}, {}};
    if (const auto alpha = channels.find("A"); alpha != channels.end()) found.alpha = alpha->second;
    return found;
}

DepthChannel findDepth(const std::vector<ExrPart>& parts, const std::string& layer, const std::filesystem::path& path) {
    std::vector<DepthCandidate> found;
    for (const Layer& one : layersOf(parts))
        if (const auto candidate = depthIn(one)) found.push_back(*candidate);
    if (found.empty())
        throw InputError(fmt::format("the picture has no layer Z or depth.Z (it has {})", channelNames(parts)),
                         path.string(), "give the depth with --depth");
    std::ranges::stable_sort(found, [&](const DepthCandidate& a, const DepthCandidate& b) {
        const std::size_t nearA = sharedLength(a.layer, layer), nearB = sharedLength(b.layer, layer);
        return a.rank != b.rank ? a.rank < b.rank : nearA > nearB;
    });
    const bool unclear = found.size() > 1 && found[0].rank > 1 && found[0].rank == found[1].rank &&
                         sharedLength(found[0].layer, layer) == sharedLength(found[1].layer, layer);
    if (unclear)
        throw InputError(fmt::format("{} and {} may both be the depth", found[0].channel.name, found[1].channel.name),
                         path.string(), "give a file with one of them by --depth");
    return found[0].channel;
}

}  // namespace lumulus::cli
