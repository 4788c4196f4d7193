#include "draw/march.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/march.comp.h"
}  // namespace spirv

}  // namespace

March::March(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features)
    : cloud_(cloud), program_(context, "march", spirv::march_comp, features.constants()) {}

void March::record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawPush& push) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("density", cloud_.density, gpu::Sampler::linear);
    bindings.emplace_back("majorants", cloud_.marchedCells());
    commands.pass("march");
    dispatchDrawing(commands, program_, bindings, inputs.squares, push);
}

}  // namespace lumulus::draw
