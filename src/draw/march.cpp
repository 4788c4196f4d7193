#include "draw/march.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/march.comp.h"
}  // namespace spirv

}  // namespace

March::March(gpu::Context& context, const DrawFeatures& features)
    : program_(context, "march", spirv::march_comp, features.constants()) {}

void March::record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                   const shared::DrawPush& push) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("majorants", inputs.volumes.majorants);
    tiles.addBindings(bindings);
    commands.pass("march");
    dispatchDrawing(commands, program_, bindings, inputs.squares, push);
}

}  // namespace lumulus::draw
