#include "fog/screen/fog.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/interrupt.h"
#include "fog/screen/chain.h"
#include "fog/screen/exact.h"
#include "fog/screen/frame_layers.h"
#include "fog/screen/scatter.h"
#include "fog/screen/spread.h"
#include "frame/pass_times.h"
#include "frame/view_params.h"
#include "gpu/transfer.h"
#include "medium/fog_media.h"
#include "shared/draw.h"

namespace lumulus::fog {

namespace {

namespace spirv {
#include "spirv/fog/lit_join.comp.h"
#include "spirv/fog/margin.comp.h"
}  // namespace spirv

/// The filter that the scene asks for.
struct Filter {
    Filter(gpu::Context& context, const scene::Fog& scene, const glm::ivec2& size) {
        if (scene.filter == scene::FogFilter::scatter)
            scatter.emplace(context, size, pyramidStep(scene.filterSize, scene.fetch));
        else if (scene.filter == scene::FogFilter::gather)
            exact.emplace(context, size);
        else
            chain.emplace(context, size, scene);
    }

    std::optional<Scatter> scatter;
    std::optional<Chain> chain;
    std::optional<Exact> exact;
};

/// A layer that comes from the host. What is seen of it takes the place of its radiance.
struct Uploaded {
    Uploaded(gpu::Context& context, const glm::ivec2& size)
        : radiance(context, "fog radiance", size, lightFormat),
          distances(context, "fog distances", size, VK_FORMAT_R32_SFLOAT) {}

    gpu::Image radiance, distances;
};

/// What pictures of one size need, made when it is first needed.
struct Surface {
    explicit Surface(const glm::ivec2& pixels) : size(pixels) {}

    glm::ivec2 size;
    std::optional<Filter> filter;
    std::optional<Uploaded> uploaded;
    std::optional<FrameLayers> layers;
    std::optional<gpu::Image> spread;
    std::optional<Uploaded> wide;  ///< light with a margin
};

/// Where a picture is seen from, and the media around it.
struct Eye {
    const Camera& camera;
    gpu::Buffer media;
};

/// Pixels around a picture in which light is spread out of it: as wide as it spreads, up to a quarter of the picture;
/// in steps, so that images stay while a camera moves.
int marginOf(const scene::Fog& scene, const Camera& camera, double farthest) {
    if (camera.projection == scene::Projection::panorama) return 0;  // it has no border but the poles
    const double step = std::ceil(std::max(camera.width, camera.height) / 16.0);
    return static_cast<int>(step * std::min(4.0, std::ceil(largestSpread(scene, camera, farthest) / step)));
}

Camera withMargin(Camera camera, int margin) {
    const double scale = (camera.height + 2.0 * margin) / camera.height;
    camera.tanHalfFov *= scale;
    camera.orthographicHeight *= scale;
    camera.width += 2 * margin;
    camera.height += 2 * margin;
    return camera;
}

}  // namespace

struct Fog::State {
    State(gpu::Context& theContext, const scene::Fog& theScene, Check theCheck)
        : context(theContext), scene(theScene), check(std::move(theCheck)), commands(theContext) {}

    gpu::Context& context;
    scene::Fog scene;
    Check check;
    gpu::Commands commands;
    std::optional<Surface> surface;
    std::optional<gpu::Program<shared::FogSpreadPush>> join;
    std::optional<gpu::Program<shared::FogMarginPush>> margin;
    std::vector<gpu::PassTime> times;

    Surface& surfaceOf(const glm::ivec2& size) {
        if (!surface || surface->size != size) {
            surface.reset();
            surface.emplace(size);
        }
        return *surface;
    }
    Eye eyeOf(const Camera& camera) {
        return {camera, gpu::filledBuffer(context, "fog media", mediaAround(scene, camera.position))};
    }
    /// What is seen of a layer, in `result`, which may be its radiance. `farthest` is the largest of its distances.
    void filter(const Eye& eye, const gpu::Image& radiance, const gpu::Image& distances, double farthest,
                const gpu::Image& result);
    void run(const LayerInputs& inputs, double largest, const gpu::Image& result);
    void submit();
};

void Fog::State::submit() {
    commands.submit();
    commands.wait();
    frame::addTimes(times, commands.times());
}

void Fog::State::filter(const Eye& eye, const gpu::Image& radiance, const gpu::Image& distances, double farthest,
                        const gpu::Image& result) {
    const LayerInputs inputs{radiance,
                             distances,
                             eye.media,
                             {frame::viewParams(eye.camera), static_cast<float>(pixelsPerRadian(eye.camera)),
                              static_cast<float>(scene.skyDistance), static_cast<int>(scene.media.size()), 0}};
    if (!surface->filter) surface->filter.emplace(context, scene, surface->size);
    run(inputs, largestSpread(scene, eye.camera, farthest), result);
}

void Fog::State::run(const LayerInputs& inputs, double largest, const gpu::Image& result) {
    Filter& made = *surface->filter;
    commands.begin();
    if (made.scatter) made.scatter->record(commands, inputs, largest, result);
    if (made.chain) made.chain->record(commands, inputs, largest, result);
    if (made.exact) made.exact->recordLight(commands, inputs);
    submit();
    if (!made.exact) return;
    for (int row = 0; row < inputs.push.view.size.y;) {
        check();
        commands.begin();
        row += made.exact->recordSources(commands, row, result);
        submit();
    }
}

Fog::Fog(gpu::Context& context, const scene::Fog& scene, Check check)
    : state_(std::make_unique<State>(context, scene, std::move(check))) {}

Fog::~Fog() = default;

void Fog::setMedia(std::vector<scene::FogMedium> media) {
    state_->scene.media = std::move(media);
}

std::vector<glm::vec4> Fog::apply(const Layer& layer, const Camera& camera) {
    State& s = *state_;
    Surface& surface = s.surfaceOf({camera.width, camera.height});
    if (!surface.uploaded) surface.uploaded.emplace(s.context, surface.size);
    const auto& [radiance, distances] = *surface.uploaded;
    gpu::upload(s.context, surface.uploaded->radiance, layer.radiance);
    gpu::upload(s.context, surface.uploaded->distances, layer.distances);
    const float farthest = *std::ranges::max_element(layer.distances);
    s.filter(s.eyeOf(camera), radiance, distances, static_cast<double>(farthest), radiance);
    return gpu::download<glm::vec4>(s.context, radiance);
}

void Fog::apply(const frame::Frame& frame, const Camera& camera, const glm::vec3& sky, const Tile& part) {
    State& s = *state_;
    Surface& surface = s.surfaceOf(frame.size());
    if (!surface.layers) surface.layers.emplace(s.context, surface.size);
    FrameLayers& layers = *surface.layers;
    s.commands.begin();
    layers.recordSplit(s.commands, frame, sky);
    s.submit();
    const FrameLayers::Present present = layers.present();
    const Eye eye = s.eyeOf(camera);
    const auto behindAll = static_cast<double>(shared::FAR_DEPTH);
    if (present.clouded) {
        s.filter(eye, frame.cloud(), frame.depth(), present.farthest, layers.seenCloud());
        s.filter(eye, layers.shadow(), layers.far(), behindAll, layers.shadow());
    }
    if (present.lit) s.filter(eye, layers.bright(), layers.far(), behindAll, layers.bright());
    const OpenSky open = openSky(s.scene, camera, sky, part);
    s.commands.begin();
    layers.recordJoin(s.commands, frame, present, open, part);
    s.submit();
}

void Fog::addSpread(const frame::Frame& frame, const Camera& camera, const gpu::Image& light, float sign,
                    double farthest) {
    State& s = *state_;
    const int margin = marginOf(s.scene, camera, farthest);
    const Camera wide = withMargin(camera, margin);
    Surface& surface = s.surfaceOf({wide.width, wide.height});
    if (!surface.spread) surface.spread.emplace(s.context, "fog spread", surface.size, lightFormat);
    if (!surface.wide) surface.wide.emplace(s.context, surface.size);
    if (!s.join) s.join.emplace(s.context, "lit_join", spirv::lit_join_comp);
    if (!s.margin) s.margin.emplace(s.context, "margin", spirv::margin_comp);
    s.commands.begin();
    s.commands.pass("fog margin");
    s.commands.dispatch(*s.margin,
                        {{"light", light, gpu::Sampler::nearest},
                         {"depth", frame.depth(), gpu::Sampler::nearest},
                         {"wideLight", surface.wide->radiance},
                         {"wideDepth", surface.wide->distances}},
                        {glm::ivec2(margin)}, gpu::pixelGroups(surface.size));
    s.submit();
    const Eye eye = s.eyeOf(wide);
    s.filter(eye, surface.wide->radiance, surface.wide->distances, farthest, *surface.spread);
    s.commands.begin();
    s.commands.pass("fog spread");
    s.commands.dispatch(*s.join,
                        {{"cloud", frame.cloud()},
                         {"radiance", frame.radiance()},
                         {"depth", frame.depth(), gpu::Sampler::nearest},
                         {"before", light, gpu::Sampler::nearest},
                         {"after", *surface.spread, gpu::Sampler::nearest},
                         {"Media", eye.media}},
                        {frame::viewParams(camera), static_cast<float>(s.scene.skyDistance),
                         static_cast<int>(s.scene.media.size()), sign, glm::ivec2(margin)},
                        gpu::pixelGroups(frame.size()));
    s.submit();
}

std::vector<gpu::PassTime> Fog::takeTimes() {
    return std::exchange(state_->times, {});
}

}  // namespace lumulus::fog
