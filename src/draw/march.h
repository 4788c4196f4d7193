#pragma once

#include "draw/drawing.h"
#include "draw/instance_tiles.h"

namespace lumulus::draw {

/// What pixels show of meshes, in their order: shared::MeshPixel each, and the distances of those with edges.
struct MeshBuffers {
    const gpu::Buffer& pixels;
    const gpu::Buffer& edges;
};

/// Draws clouds by marching through their density.
class March {
  public:
    March(gpu::Context& context, const DrawFeatures& features);
    /// Records one pass over some pixels. `meshes`: null without DrawFeatures::mesh.
    void record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                const MeshBuffers* meshes, const shared::DrawPush& push) const;

  private:
    DrawProgram program_;
};

}  // namespace lumulus::draw
