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
    constants.push_back(gpu::SpecConstant::of(10, features.mesh));
    return constants;
}

}  // namespace

March::March(gpu::Context& context, const DrawFeatures& features)
    : program_(context, "march", spirv::march_comp, constantsOf(features)) {}

void March::record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                   const MeshBuffers* meshes, const shared::DrawPush& push) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("majorants", inputs.volumes.majorants);
    tiles.addBindings(bindings);
    bindings.emplace_back("TileDetail", tiles.detail());
    // what is not read needs a buffer nevertheless
    bindings.emplace_back("MeshPixels", meshes != nullptr ? meshes->pixels : inputs.params);
    bindings.emplace_back("MeshEdges", meshes != nullptr ? meshes->edges : inputs.params);
    commands.pass("march");
    dispatchDrawing(commands, program_, bindings, inputs.squares, push);
}

}  // namespace lumulus::draw
