#include "cli/composite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/exr.h"
#include "base/log.h"
#include "base/stopwatch.h"
#include "base/version.h"
#include "cli/output.h"
#include "cli/stats_json.h"
#include "fog/screen/depth.h"
#include "fog/screen/fog.h"
#include "scene/load.h"
#include "view/camera.h"

namespace lumulus::cli {
namespace {

/// Largest radiance; sums of larger values would leave the range of floats.
constexpr float brightest = 1e20F;

std::string layerNames(const LayeredImage& image) {
    std::vector<std::string> names;
    for (const auto& layer : image.layers) names.push_back(layer.first);
    return fmt::format("{}", fmt::join(names, ", "));
}

/// R, G, B as texels with alpha 1. Values that are no finite numbers become black, with a warning.
std::vector<glm::vec4> radianceOf(const LayeredImage& image, const std::filesystem::path& path) {
    std::vector<glm::vec4> radiance(image.pixels(), glm::vec4(1.0F));
    std::size_t bad = 0;
    const char* names[3] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel) {
        const auto layer = image.layers.find(names[channel]);
        if (layer == image.layers.end())
            throw InputError(fmt::format("the picture has no layer {} (it has {})", names[channel], layerNames(image)),
                             path.string(), "give one with R, G and B");
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            const float value = layer->second[i];
            bad += std::isfinite(value) ? 0 : 1;
            radiance[i][channel] = std::isfinite(value) ? std::clamp(value, -brightest, brightest) : 0.0F;
        }
    }
    if (bad > 0) logWarning(fmt::format("{} values of {} are not finite numbers and count as 0", bad, path.string()));
    return radiance;
}

std::vector<float> distancesOf(LayeredImage& image, const std::filesystem::path& path, const scene::Fog& fog,
                               const Camera& camera) {
    for (const char* name : {"Z", "depth.Z"}) {
        const auto layer = image.layers.find(name);
        if (layer == image.layers.end()) continue;
        const std::size_t bad = fog::depthToDistance(layer->second, fog, camera);
        if (bad > 0) logWarning(fmt::format("{} depths of {} are negative or no numbers", bad, path.string()));
        return std::move(layer->second);
    }
    throw InputError(fmt::format("the picture has no layer Z or depth.Z (it has {})", layerNames(image)), path.string(),
                     "give the depth with --depth");
}

void setRadiance(LayeredImage& image, const std::vector<glm::vec4>& radiance) {
    const char* names[3] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& layer = image.layer(names[channel]);
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = radiance[i][channel];
    }
}

void checkSameSize(const LayeredImage& color, const LayeredImage& depth, const std::filesystem::path& path) {
    if (color.width == depth.width && color.height == depth.height) return;
    throw InputError(fmt::format("the depth has {} × {} pixels, the picture {} × {}", depth.width, depth.height,
                                 color.width, color.height),
                     path.string(), "give both in one size");
}

/// Shows the picture through the fog, in place.
void applyFog(LayeredImage& color, const CompositeOptions& options, const scene::Scene& scene, Statistics& statistics) {
    LayeredImage depth = options.depth.empty() ? color : readExr(options.depth);
    const std::filesystem::path& depthPath = options.depth.empty() ? options.color : options.depth;
    checkSameSize(color, depth, depthPath);
    scene::Image size = scene.image;
    size.width = color.width;
    size.height = color.height;
    const Camera camera = makeCamera(scene.camera, size, Bounds{});
    const fog::Layer layer{radianceOf(color, options.color), distancesOf(depth, depthPath, scene.fog, camera)};

    gpu::Context context({options.device, options.validate});
    fog::Fog fog(context, scene.fog);
    setRadiance(color, fog.apply(layer, camera));
    statistics.device = context.device().name;
    statistics.gpuBytes = context.memory().used;
    statistics.gpuBytesHeld = context.memory().held;
    for (const gpu::PassTime& pass : fog.takeTimes())
        statistics.passes.push_back({pass.name, pass.milliseconds, Stage::fog});
    statistics.validationMessages = context.validationMessages();
}

}  // namespace

void runComposite(const CompositeOptions& options) {
    const Stopwatch total;
    std::vector<std::filesystem::path> places = options.outputs;
    for (const auto& output : places) requireSuffix(output, {".exr", ".png"});
    if (!options.stats.empty() && options.stats != "-") places.emplace_back(options.stats);
    checkPlaces(places);
    const scene::Scene scene = scene::loadScene(options.scene, options.overrides);

    Statistics statistics;
    const Stopwatch loading;
    LayeredImage color = readExr(options.color);
    statistics.loadSeconds = loading.seconds();
    const Stopwatch drawing;
    if (!scene.fog.media.empty()) applyFog(color, options, scene, statistics);
    statistics.drawSeconds = drawing.seconds();
    // depth and other layers of the file do not describe the picture through the fog
    std::erase_if(color.layers, [](const auto& layer) {
        return layer.first.size() != 1 || std::string_view("RGBA").find(layer.first) == std::string_view::npos;
    });
    color.attributes["scene"] = scene.source;
    color.attributes["software"] = std::string("lumulus ") + version;

    const Stopwatch writing;
    for (const auto& output : options.outputs) writePicture(output, color, scene.image.exposure);
    writeStatistics(options.stats, statisticsJson(statistics, std::nullopt, writing.seconds(), total.seconds()));
    requireNoMessages(options.validate, statistics);
}

}  // namespace lumulus::cli
