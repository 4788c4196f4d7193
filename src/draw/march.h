#pragma once

#include "cloud/cloud.h"
#include "draw/frame.h"

namespace lumulus::draw {

/// Draws a cloud by marching through its density.
class March {
  public:
    March(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features);
    /// Records one band of rows.
    void record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawParams& values) const;

  private:
    const cloud::Cloud& cloud_;
    gpu::Program<gpu::NoPush> program_;
};

}  // namespace lumulus::draw
