#pragma once

#include <optional>

#include "fog/screen/light.h"
#include "fog/screen/pyramid.h"

namespace lumulus::fog {

/// The filters of the papers, which gather: each pixel reads a chain of blurred copies at the level of its own spread.
/// Naive: the plain chain (Elek 2013). Masked: with masked light, levels found in the blurred depth, and bright near
/// light apart (Elek 2013, Iser 2017).
class Chain {
  public:
    /// `fog.filter` must be naive or masked.
    Chain(gpu::Context& context, const glm::ivec2& size, const scene::Fog& fog);

    /// Records the passes that filter the layer and write what is seen of it to `result`. `largest` bounds its spread
    /// in pixels.
    void record(gpu::Commands& commands, const LayerInputs& layer, double largest, const gpu::Image& result);

  private:
    /// What the masked filter has beyond the naive one.
    struct Masked {
        Masked(gpu::Context& context, const glm::ivec2& extent, const PyramidStep& step, bool separate);
        gpu::Image depth, separated;
        gpu::Program<shared::SeparationPush> prepare;
        gpu::Program<shared::LevelPush> down;
    };

    void recordDown(gpu::Commands& commands, const shared::LevelPush& levels);
    bool separates() const { return masked_ && fog_.separation > 0.0; }

    scene::Fog fog_;
    PyramidStep step_;
    Pyramid pyramid_;
    gpu::Image sharp_, scattered_, levels_;
    gpu::Program<shared::FogPush> prepare_;
    std::optional<Masked> masked_;
    std::optional<gpu::Program<shared::LevelPush>> naiveDown_;
    gpu::Program<shared::FetchPush> fetch_;
};

}  // namespace lumulus::fog
