#include "cli/composite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.h"
#include "base/exr.h"
#include "base/log.h"
#include "base/stopwatch.h"
#include "base/version.h"
#include "cli/exr_layers.h"
#include "cli/output.h"
#include "cli/stats_json.h"
#include "fog/screen/depth.h"
#include "fog/screen/fog.h"
#include "scene/load.h"
#include "view/view.h"

namespace lumulus::cli {
namespace {

/// Largest radiance; sums of larger values would leave the range of floats.
constexpr float brightest = 1e20F;

constexpr const char* colours[3] = {"R", "G", "B"};

/// A picture under the names R, G, B and A, with where its pixels lie.
struct Picture {
    LayeredImage image;
    std::vector<ExrPart> parts;  ///< of its file
    std::string layer;
    ExrWindows windows;
};

Picture readPicture(const CompositeOptions& options) {
    Picture picture;
    picture.parts = listExrParts(options.color);
    const ColourChannels found = findColour(picture.parts, options.layer, options.color);
    std::vector<std::string> names(found.names.begin(), found.names.end());
    if (found.alpha) names.push_back(*found.alpha);
    LayeredImage read = readExrChannels(options.color, found.part, names);
    picture.layer = found.layer;
    picture.windows = picture.parts[found.part].windows;
    picture.image.width = read.width;
    picture.image.height = read.height;
    picture.image.attributes = std::move(read.attributes);
    for (std::size_t c = 0; c < 3; ++c) picture.image.layers[colours[c]] = read.layers.at(found.names[c]);
    if (found.alpha) picture.image.layers["A"] = read.layers.at(*found.alpha);
    return picture;
}

/// R, G, B as texels with alpha 1. Values that are no finite numbers become black, with a warning.
std::vector<glm::vec4> radianceOf(const LayeredImage& image, const std::filesystem::path& path) {
    std::vector<glm::vec4> radiance(image.pixels(), glm::vec4(1.0F));
    std::size_t bad = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float>& layer = image.layers.at(colours[channel]);
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            const float value = layer[i];
            bad += std::isfinite(value) ? 0 : 1;
            radiance[i][channel] = std::isfinite(value) ? std::clamp(value, -brightest, brightest) : 0.0F;
        }
    }
    if (bad > 0) logWarning(fmt::format("{} values of {} are not finite numbers and count as 0", bad, path.string()));
    return radiance;
}

std::string textOf(const ExrWindow& window) {
    return fmt::format("({} {}) - ({} {})", window.x, window.y, window.x + window.width - 1,
                       window.y + window.height - 1);
}

/// The pixels of `values`, which cover `from`, in the window `part`.
std::vector<float> cropped(const std::vector<float>& values, const ExrWindow& from, const ExrWindow& part,
                           const std::filesystem::path& path) {
    const bool covers = from.x <= part.x && from.y <= part.y && from.x + from.width >= part.x + part.width &&
                        from.y + from.height >= part.y + part.height;
    if (!covers && (from.width != part.width || from.height != part.height))
        throw InputError(fmt::format("the depth has {} × {} pixels, the picture {} × {}", from.width, from.height,
                                     part.width, part.height),
                         path.string(), "give both in one size");
    if (!covers)
        throw InputError(fmt::format("the depth has the data window {}, the picture {}", textOf(from), textOf(part)),
                         path.string(), "give both in one window");
    std::vector<float> result;
    result.reserve(static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height));
    for (int y = part.y; y < part.y + part.height; ++y) {
        const auto row = values.begin() + static_cast<std::ptrdiff_t>(y - from.y) * from.width + (part.x - from.x);
        result.insert(result.end(), row, row + part.width);
    }
    return result;
}

std::vector<float> distancesOf(const Picture& picture, const CompositeOptions& options, const scene::Fog& fog,
                               const Camera& camera) {
    const bool same = options.depth.empty();
    const std::filesystem::path& path = same ? options.color : options.depth;
    const std::vector<ExrPart> parts = same ? picture.parts : listExrParts(path);
    const DepthChannel channel = findDepth(parts, picture.layer, path);
    LayeredImage read = readExrChannels(path, channel.part, std::span(&channel.name, 1));
    std::vector<float> depth =
        cropped(read.layers.at(channel.name), parts[channel.part].windows.data, picture.windows.data, path);
    const std::size_t bad = fog::depthToDistance(depth, fog, camera);
    if (bad > 0) logWarning(fmt::format("{} depths of {} are negative or no numbers", bad, path.string()));
    return depth;
}

void setRadiance(LayeredImage& image, const std::vector<glm::vec4>& radiance) {
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& layer = image.layer(colours[channel]);
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = radiance[i][channel];
    }
}

/// The scene's camera looks through the display window, the picture is its data window.
Camera cameraOf(const scene::Scene& scene, const ExrWindows& windows) {
    const ExrWindow &display = windows.display, &data = windows.data;
    scene::Image size = scene.image;
    size.width = display.width;
    size.height = display.height;
    return windowCamera(makeCamera(scene.camera, size, Bounds{}),
                        {data.x - display.x, data.y - display.y, data.width, data.height});
}

/// Shows the picture through the fog, in place.
void applyFog(Picture& picture, const CompositeOptions& options, const scene::Scene& scene, Statistics& statistics) {
    const Camera camera = cameraOf(scene, picture.windows);
    const fog::Layer layer{radianceOf(picture.image, options.color), distancesOf(picture, options, scene.fog, camera)};

    gpu::Context context({options.device, options.validate});
    fog::Fog fog(context, scene.fog);
    setRadiance(picture.image, fog.apply(layer, camera));
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
    const scene::Scene scene = scene::loadScene(options.scene, options.overrides, std::nullopt,
                                                static_cast<double>(options.frame.value_or(0)));

    Statistics statistics;
    const Stopwatch loading;
    Picture picture = readPicture(options);
    LayeredImage& image = picture.image;
    statistics.loadSeconds = loading.seconds();
    const Stopwatch drawing;
    if (!scene.fog.media.empty()) applyFog(picture, options, scene, statistics);
    statistics.drawSeconds = drawing.seconds();
    if (!scene.image.background) image.layer("A", 1.0F);  // a picture without alpha covers all
    image.attributes["scene"] = scene.source;
    image.attributes["software"] = std::string("lumulus ") + version;

    const Stopwatch writing;
    for (const auto& output : options.outputs) writePicture(output, image, scene.image, picture.windows);
    writeStatistics(options.stats, statisticsJson(statistics, std::nullopt, writing.seconds(), total.seconds()));
    requireNoMessages(options.validate, statistics);
}

}  // namespace lumulus::cli
