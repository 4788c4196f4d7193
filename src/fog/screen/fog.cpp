#include "fog/screen/fog.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/interrupt.h"
#include "fog/screen/chain.h"
#include "fog/screen/exact.h"
#include "fog/screen/scatter.h"
#include "fog/screen/spread.h"
#include "frame/view_params.h"
#include "gpu/transfer.h"
#include "medium/fog_media.h"

namespace lumulus::fog {

namespace {

/// What pictures of one size need.
struct Surface {
    Surface(gpu::Context& context, const scene::Fog& scene, const glm::ivec2& size)
        : radiance(context, "fog radiance", size, lightFormat),
          distances(context, "fog distances", size, VK_FORMAT_R32_SFLOAT),
          result(context, "fog result", size, lightFormat) {
        if (scene.filter == scene::FogFilter::scatter)
            scatter.emplace(context, size, pyramidStep(scene.filterSize, scene.fetch));
        else if (scene.filter == scene::FogFilter::gather)
            exact.emplace(context, size);
        else
            chain.emplace(context, size, scene);
    }

    gpu::Image radiance, distances, result;
    // the one that the scene asks for
    std::optional<Scatter> scatter;
    std::optional<Chain> chain;
    std::optional<Exact> exact;
};

void addTimes(std::vector<gpu::PassTime>& sums, const std::vector<gpu::PassTime>& times) {
    for (const gpu::PassTime& time : times) {
        const auto known = std::ranges::find(sums, time.name, &gpu::PassTime::name);
        if (known == sums.end())
            sums.push_back(time);
        else
            known->milliseconds += time.milliseconds;
    }
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
    std::vector<gpu::PassTime> times;

    void run(const LayerInputs& inputs, double largest);
    void submit();
};

void Fog::State::submit() {
    commands.submit();
    commands.wait();
    addTimes(times, commands.times());
}

void Fog::State::run(const LayerInputs& inputs, double largest) {
    commands.begin();
    if (surface->scatter) surface->scatter->record(commands, inputs, largest, surface->result);
    if (surface->chain) surface->chain->record(commands, inputs, largest, surface->result);
    if (surface->exact) surface->exact->recordLight(commands, inputs);
    submit();
    if (!surface->exact) return;
    for (int row = 0; row < inputs.push.view.size.y;) {
        check();
        commands.begin();
        row += surface->exact->recordSources(commands, row, surface->result);
        submit();
    }
}

Fog::Fog(gpu::Context& context, const scene::Fog& scene, Check check)
    : state_(std::make_unique<State>(context, scene, std::move(check))) {}

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
    const gpu::Buffer media = gpu::filledBuffer(s.context, "fog media", mediaAround(s.scene, camera.position));
    const LayerInputs inputs{surface.radiance,
                             surface.distances,
                             media,
                             {frame::viewParams(camera), static_cast<float>(pixelsPerRadian(camera)),
                              static_cast<float>(s.scene.skyDistance), static_cast<int>(s.scene.media.size()), 0}};
    const float farthest = *std::ranges::max_element(layer.distances);
    s.run(inputs, largestSpread(s.scene, camera, static_cast<double>(farthest)));
    return gpu::download<glm::vec4>(s.context, surface.result);
}

const scene::Fog& Fog::scene() const {
    return state_->scene;
}

std::vector<gpu::PassTime> Fog::takeTimes() {
    return std::exchange(state_->times, {});
}

}  // namespace lumulus::fog
