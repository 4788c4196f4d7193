#pragma once

#include "draw/drawing.h"

namespace lumulus::draw {

/// Draws clouds by marching through their density.
class March {
  public:
    March(gpu::Context& context, const DrawFeatures& features);
    /// Records one pass over some pixels.
    void record(gpu::Commands& commands, const DrawInputs& inputs, const shared::DrawPush& push) const;

  private:
    DrawProgram program_;
};

}  // namespace lumulus::draw
