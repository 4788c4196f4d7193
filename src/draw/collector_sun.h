#pragma once

#include <span>

#include "draw/sun_depth.h"

namespace lumulus::draw {

/// Optical depth to the sun of each leaf as a whole, for billboards: a ray meets their spheres also where the leaf has
/// no density, and the depth to the sun at such a place says nothing of the leaf.
class CollectorSun {
  public:
    CollectorSun(gpu::Context& context, const cloud::Cloud& cloud);

    /// Records what fills values(), after the depths have been recorded and a barrier.
    void record(gpu::Commands& commands, const SunDepth& depths) const;

    /// One a collector, once the commands are done.
    std::span<const float> values() const;

  private:
    const cloud::Cloud& cloud_;
    gpu::Program<shared::CollectorSunPush> program_;
    gpu::Buffer boxes_, values_;
};

}  // namespace lumulus::draw
