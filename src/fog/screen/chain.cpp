#include "fog/screen/chain.h"

#include "gpu/transfer.h"

namespace lumulus::fog {

namespace {

namespace spirv {
#include "spirv/fog/chain_fetch.comp.h"
#include "spirv/fog/gather_prepare.comp.h"
#include "spirv/fog/masked_down.comp.h"
#include "spirv/fog/masked_prepare.comp.h"
#include "spirv/fog/naive_down.comp.h"
}  // namespace spirv

/// The rectangles of the levels as a table that shaders fetch from.
gpu::Image levelTable(gpu::Context& context, const Pyramid& pyramid) {
    std::vector<glm::vec4> texels;
    for (const Pyramid::Level& level : pyramid.levels) texels.emplace_back(glm::ivec4(level.offset, level.size));
    gpu::Image table(context, "fog levels", glm::ivec2(static_cast<int>(texels.size()), 1), lightFormat);
    gpu::upload(context, table, texels);
    return table;
}

int fetchNumber(scene::FogFetch fetch) {
    if (fetch == scene::FogFetch::bilinear) return 0;
    return fetch == scene::FogFetch::linearBicubic ? 1 : 2;
}

}  // namespace

Chain::Masked::Masked(gpu::Context& context, const glm::ivec2& extent, const PyramidStep& step, bool separate)
    : depth(emptyImage(context, "fog depth", extent, VK_FORMAT_R32_SFLOAT)),
      separated(emptyImage(context, "fog separated", extent, lightFormat)),
      prepare(context, "masked_prepare", spirv::masked_prepare_comp),
      down(context, "masked_down", spirv::masked_down_comp,
           {gpu::SpecConstant::of(0, step.pairs), gpu::SpecConstant::of(1, separate)}) {}

Chain::Chain(gpu::Context& context, const glm::ivec2& size, const scene::Fog& fog)
    : fog_(fog),
      step_(pyramidStep(fog.filterSize, fog.fetch)),
      pyramid_(makePyramid(size)),
      sharp_(context, "fog sharp", size, lightFormat),
      scattered_(emptyImage(context, "fog scattered", pyramid_.image, lightFormat)),
      levels_(levelTable(context, pyramid_)),
      prepare_(context, "gather_prepare", spirv::gather_prepare_comp),
      fetch_(context, "chain_fetch", spirv::chain_fetch_comp,
             {gpu::SpecConstant::of(0, fog.filter == scene::FogFilter::masked),
              gpu::SpecConstant::of(1, fog.separation > 0.0), gpu::SpecConstant::of(2, fetchNumber(fog.fetch))}) {
    if (fog.filter == scene::FogFilter::masked) {
        masked_.emplace(context, pyramid_.image, step_, fog.separation > 0.0);
    } else {
        naiveDown_.emplace(context, "naive_down", spirv::naive_down_comp,
                           std::vector{gpu::SpecConstant::of(0, step_.pairs)});
    }
}

void Chain::recordDown(gpu::Commands& commands, const shared::LevelPush& levels) {
    const glm::uvec3 groups = gpu::pixelGroups(levels.coarserSize);
    if (!masked_) {
        commands.dispatch(*naiveDown_, {{"finer", scattered_, gpu::Sampler::linearClamp}, {"coarser", scattered_}},
                          levels, groups);
        return;
    }
    commands.dispatch(masked_->down,
                      {{"scatteredFiner", scattered_, gpu::Sampler::linearClamp},
                       {"depthFiner", masked_->depth, gpu::Sampler::linearClamp},
                       {"separatedFiner", masked_->separated, gpu::Sampler::linearClamp},
                       {"scattered", scattered_},
                       {"depth", masked_->depth},
                       {"separated", masked_->separated}},
                      levels, groups);
}

void Chain::record(gpu::Commands& commands, const LayerInputs& layer, double largest, const gpu::Image& result) {
    const glm::ivec2 size = layer.push.view.size;
    const int last = levelsFor(largest, step_, pyramid_.last());
    commands.pass("fog light");
    std::vector<gpu::Binding> bindings = layer.bindings();
    bindings.emplace_back("sharp", sharp_);
    bindings.emplace_back("scattered", scattered_);
    commands.dispatch(prepare_, bindings, layer.push, gpu::pixelGroups(size));
    if (masked_) {
        commands.barrier("fog light");
        commands.dispatch(masked_->prepare,
                          {{"scattered", scattered_}, {"depth", masked_->depth}, {"separated", masked_->separated}},
                          {size, static_cast<float>(fog_.separation), static_cast<float>(fog_.separationLuminance),
                           static_cast<float>(fog_.separationSpread * size.y)},
                          gpu::pixelGroups(size));
    }
    commands.pass("fog down");
    for (int level = 1; level <= last; ++level) {
        commands.barrier("fog level");
        recordDown(commands, pyramid_.between(level, last, step_.scale()));
    }
    commands.barrier("fog chains");
    commands.pass("fog fetch");
    // what a variant does not have is never read, but every binding must be there
    const gpu::Image& depth = masked_ ? masked_->depth : scattered_;
    const gpu::Image& separated = masked_ ? masked_->separated : scattered_;
    commands.dispatch(fetch_,
                      {{"sharp", sharp_, gpu::Sampler::nearest},
                       {"scattered", scattered_, gpu::Sampler::linearClamp},
                       {"depth", depth, gpu::Sampler::linearClamp},
                       {"separated", separated, gpu::Sampler::linearClamp},
                       {"levels", levels_, gpu::Sampler::nearest},
                       {"result", result}},
                      {size, 1.0F / glm::vec2(pyramid_.image), last, static_cast<float>(step_.scale()),
                       fog_.depthLookups, static_cast<float>(fog_.separationLevel)},
                      gpu::pixelGroups(size));
}

}  // namespace lumulus::fog
