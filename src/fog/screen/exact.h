#pragma once

#include "fog/screen/light.h"

namespace lumulus::fog {

/// The exact filter of the model: each pixel's scattered light spread by a Gaussian of its own width. The time grows
/// with the square of the pixels.
class Exact {
  public:
    Exact(gpu::Context& context, const glm::ivec2& size);

    /// Records the light of the layer, before any recordSources().
    void recordLight(gpu::Commands& commands, const LayerInputs& layer);
    /// Records the spreading of the next rows of sources, beginning with row `firstRow`, into `result`; returns how
    /// many. Rows must come in order from 0.
    int recordSources(gpu::Commands& commands, int firstRow, const gpu::Image& result);

  private:
    glm::ivec2 size_;
    int rowsAtOnce_;
    gpu::Image sharp_, scattered_, across_, down_;
    gpu::Program<shared::FogPush> prepare_;
    gpu::Program<shared::ExactPush> shareAcross_, shareDown_, spread_;
};

}  // namespace lumulus::fog
