#include "fog/fog.h"

#include <algorithm>
#include <optional>

#include "draw/frame.h"
#include "draw/view.h"
#include "fog/media.h"
#include "fog/scatter.h"
#include "gpu/transfer.h"

namespace lumulus::fog {

namespace {

/// What a filter needs for pictures of one size.
struct Surface {
    Surface(gpu::Context& context, const scene::Fog& scene, const glm::ivec2& size)
        : radiance(context, "fog radiance", size, lightFormat),
          distances(context, "fog distances", size, VK_FORMAT_R32_SFLOAT),
          result(context, "fog result", size, lightFormat) {
        scatter.emplace(context, size, pyramidStep(scene.filterSize, scene.fetch));
    }

    gpu::Image radiance, distances, result;
    std::optional<Scatter> scatter;
};

}  // namespace

struct Fog::State {
    State(gpu::Context& theContext, const scene::Fog& theScene)
        : context(theContext), scene(theScene), commands(theContext) {}

    gpu::Context& context;
    scene::Fog scene;
    gpu::Commands commands;
    std::optional<Surface> surface;
};

Fog::Fog(gpu::Context& context, const scene::Fog& scene) : state_(std::make_unique<State>(context, scene)) {}

Fog::~Fog() = default;

std::vector<glm::vec4> Fog::apply(const Layer& layer, const Camera& camera) {
    State& s = *state_;
    const glm::ivec2 size(camera.width, camera.height);
    if (!s.surface || glm::ivec2(s.surface->result.extent()) != size) {
        s.surface.reset();
        s.surface.emplace(s.context, s.scene, size);
    }
    Surface& surface = *s.surface;
    gpu::upload(s.context, surface.radiance, layer.radiance);
    gpu::upload(s.context, surface.distances, layer.distances);
    const gpu::Buffer media = draw::filledBuffer(s.context, "fog media", mediaAround(s.scene, camera.position));
    const LayerInputs inputs{surface.radiance,
                             surface.distances,
                             media,
                             {draw::viewParams(camera), static_cast<float>(pixelsPerRadian(camera)),
                              static_cast<float>(s.scene.skyDistance), static_cast<int>(s.scene.media.size()), 0}};
    const float farthest = *std::ranges::max_element(layer.distances);
    s.commands.begin();
    surface.scatter->record(s.commands, inputs, largestSpread(s.scene, camera, static_cast<double>(farthest)),
                            surface.result);
    s.commands.submit();
    s.commands.wait();
    return gpu::download<glm::vec4>(s.context, surface.result);
}

const std::vector<gpu::PassTime>& Fog::times() const {
    return state_->commands.times();
}

}  // namespace lumulus::fog
