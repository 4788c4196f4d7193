#pragma once

#include "cloud/cloud.h"
#include "draw/drawing.h"

namespace lumulus::draw {

/// Draws a cloud by marching through its density.
class March {
  public:
    March(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features);
    /// Records one pass over some pixels.
    void record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawPush& push) const;

  private:
    const cloud::Cloud& cloud_;
    DrawProgram program_;
};

}  // namespace lumulus::draw
