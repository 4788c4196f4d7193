#pragma once

#include "draw/drawing.h"
#include "draw/instance_tiles.h"

namespace lumulus::draw {

/// Draws clouds by marching through their density.
class March {
  public:
    March(gpu::Context& context, const DrawFeatures& features);
    /// Records one pass over some pixels.
    void record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                const shared::DrawPush& push) const;

  private:
    DrawProgram program_;
};

}  // namespace lumulus::draw
