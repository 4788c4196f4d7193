#include "fog/screen/exact.h"

#include <algorithm>

namespace lumulus::fog {

namespace {

namespace spirv {
#include "spirv/fog/exact.comp.h"
#include "spirv/fog/exact_shares.comp.h"
#include "spirv/fog/gather_prepare.comp.h"
}  // namespace spirv

/// Rows of sources whose shares lie in the tables at once: no taller than images may be, nor larger than 32 MiB, nor
/// more than a second's work on two cores (it can be interrupted only in between), where that is a row.
int tableRows(const glm::ivec2& size) {
    constexpr double tallest = 4096, texels = 8.0 * 1024 * 1024, shares = 256.0 * 1024 * 1024;
    const double sources = size.x, pixels = sources * size.y;
    const double rows = std::min({tallest / sources, texels / (sources * sources), shares / (sources * pixels)});
    return static_cast<int>(std::clamp(rows, 1.0, static_cast<double>(size.y)));
}

}  // namespace

Exact::Exact(gpu::Context& context, const glm::ivec2& size)
    : size_(size),
      rowsAtOnce_(tableRows(size)),
      sharp_(context, "fog sharp", size, lightFormat),
      scattered_(context, "fog scattered", size, lightFormat),
      across_(context, "fog shares across", glm::ivec2(size.x, size.x * rowsAtOnce_), VK_FORMAT_R32_SFLOAT),
      down_(context, "fog shares down", glm::ivec2(size.y, size.x * rowsAtOnce_), VK_FORMAT_R32_SFLOAT),
      prepare_(context, "gather_prepare", spirv::gather_prepare_comp),
      shareAcross_(context, "exact_shares", spirv::exact_shares_comp, {gpu::SpecConstant::of(0, 0)}),
      shareDown_(context, "exact_shares", spirv::exact_shares_comp, {gpu::SpecConstant::of(0, 1)}),
      spread_(context, "exact", spirv::exact_comp) {}

void Exact::recordLight(gpu::Commands& commands, const LayerInputs& layer) {
    std::vector<gpu::Binding> bindings = layer.bindings();
    bindings.emplace_back("sharp", sharp_);
    bindings.emplace_back("scattered", scattered_);
    commands.pass("fog light");
    commands.dispatch(prepare_, bindings, layer.push, gpu::pixelGroups(size_));
}

int Exact::recordSources(gpu::Commands& commands, int firstRow, const gpu::Image& result) {
    const int rows = std::min(rowsAtOnce_, size_.y - firstRow);
    const shared::ExactPush push{size_, firstRow, rows};
    commands.pass("fog exact");
    commands.dispatch(shareAcross_, {{"scattered", scattered_, gpu::Sampler::nearest}, {"shares", across_}}, push,
                      gpu::pixelGroups({size_.x, rows * size_.x}));
    commands.dispatch(shareDown_, {{"scattered", scattered_, gpu::Sampler::nearest}, {"shares", down_}}, push,
                      gpu::pixelGroups({size_.y, rows * size_.x}));
    commands.barrier("fog shares");
    commands.dispatch(spread_,
                      {{"scattered", scattered_, gpu::Sampler::nearest},
                       {"sharp", sharp_, gpu::Sampler::nearest},
                       {"across", across_, gpu::Sampler::nearest},
                       {"down", down_, gpu::Sampler::nearest},
                       {"result", result}},
                      push, gpu::pixelGroups(size_));
    return rows;
}

}  // namespace lumulus::fog
