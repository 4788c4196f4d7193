#include "fog/screen/scatter.h"

namespace lumulus::fog {

namespace {

namespace spirv {
#include "spirv/fog/scatter_down.comp.h"
#include "spirv/fog/scatter_prepare.comp.h"
#include "spirv/fog/scatter_up.comp.h"
}  // namespace spirv

}  // namespace

Scatter::Scatter(gpu::Context& context, const glm::ivec2& size, const PyramidStep& step)
    : step_(step),
      pyramid_(makePyramid(size)),
      kept_(emptyImage(context, "fog kept", pyramid_.image, lightFormat)),
      halfway_(emptyImage(context, "fog halfway", pyramid_.image, lightFormat)),
      passed_(emptyImage(context, "fog passed", pyramid_.image, lightFormat)),
      prepare_(context, "scatter_prepare", spirv::scatter_prepare_comp,
               {gpu::SpecConstant::of(0, static_cast<float>(step_.variance))}),
      down_(context, "scatter_down", spirv::scatter_down_comp,
            {gpu::SpecConstant::of(0, step_.pairs), gpu::SpecConstant::of(1, static_cast<float>(step_.variance))}),
      up_(context, "scatter_up", spirv::scatter_up_comp, {gpu::SpecConstant::of(0, step_.cubic)}) {}

void Scatter::record(gpu::Commands& commands, const LayerInputs& layer, double largest, const gpu::Image& result) {
    const int last = levelsFor(largest, step_, pyramid_.last());
    commands.pass("fog light");
    std::vector<gpu::Binding> bindings = layer.bindings();
    for (const auto& [name, image] : {std::pair{"kept", &kept_}, {"halfway", &halfway_}, {"passed", &passed_}})
        bindings.emplace_back(name, *image);
    shared::FogPush push = layer.push;
    push.last = last;
    commands.dispatch(prepare_, bindings, push, gpu::pixelGroups(push.view.size));
    commands.pass("fog down");
    for (int level = 1; level <= last; ++level) {
        commands.barrier("fog level");
        const shared::LevelPush levels = pyramid_.between(level, last, 0.0);
        commands.dispatch(down_,
                          {{"passedFiner", passed_, gpu::Sampler::linearClamp},
                           {"kept", kept_},
                           {"halfway", halfway_},
                           {"passed", passed_}},
                          levels, gpu::pixelGroups(levels.coarserSize));
    }
    commands.pass("fog up");
    for (int level = last + 1; level >= 1; --level) {
        commands.barrier("fog level");
        const shared::LevelPush levels = pyramid_.between(level, last, 0.0);
        commands.dispatch(up_,
                          {{"kept", kept_, gpu::Sampler::linearClamp},
                           {"halfway", halfway_, gpu::Sampler::linearClamp},
                           {"coarser", passed_, gpu::Sampler::linearClamp},
                           {"gathered", passed_},
                           {"result", result}},
                          levels, gpu::pixelGroups(levels.finerSize));
    }
}

}  // namespace lumulus::fog
