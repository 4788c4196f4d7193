#include "draw/march.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/march.comp.h"
}  // namespace spirv

std::vector<gpu::SpecConstant> constantsOf(const DrawFeatures& features) {
    std::vector<gpu::SpecConstant> constants = features.constants();
    constants.push_back(gpu::SpecConstant::of(6, features.ground));
    constants.push_back(gpu::SpecConstant::of(7, features.thickVoxels));
    return constants;
}

}  // namespace

March::March(gpu::Context& context, const DrawFeatures& features)
    : program_(context, "march", spirv::march_comp, constantsOf(features)) {}

void March::record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                   const shared::DrawPush& push) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("majorants", inputs.volumes.majorants);
    tiles.addBindings(bindings);
    bindings.emplace_back("TileDetail", tiles.detail());
    commands.pass("march");
    dispatchDrawing(commands, program_, bindings, inputs.squares, push);
}

}  // namespace lumulus::draw
