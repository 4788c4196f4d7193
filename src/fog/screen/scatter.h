#pragma once

#include "fog/screen/light.h"
#include "fog/screen/pyramid.h"

namespace lumulus::fog {

/// The scattering pyramid: one chain down, one up. Each level keeps the light whose spread is its own, so that light is
/// spread by where it comes from and none is lost.
class Scatter {
  public:
    Scatter(gpu::Context& context, const glm::ivec2& size, const PyramidStep& step);

    /// Records the passes that filter the layer and write what is seen of it to `result`. `largest` bounds its spread
    /// in pixels.
    void record(gpu::Commands& commands, const LayerInputs& layer, double largest, const gpu::Image& result);

  private:
    PyramidStep step_;
    Pyramid pyramid_;
    gpu::Image kept_, halfway_, passed_;
    gpu::Program<shared::FogPush> prepare_;
    gpu::Program<shared::LevelPush> down_, up_;
};

}  // namespace lumulus::fog
