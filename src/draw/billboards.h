#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud/cloud.h"
#include "draw/drawing.h"
#include "draw/tiles.h"
#include "gpu/commands.h"
#include "shared/draw.h"
#include "view/camera.h"

namespace lumulus::draw {

/// One billboard a collector, relative to the eye, nearest first (ties by index). `shares`: see billboardShares().
std::vector<shared::Billboard> makeBillboards(const cloud::Cloud& cloud, std::span<const float> shares,
                                              const Camera& camera);

/// Draws a cloud as billboards into bands of pixels.
class Billboards {
  public:
    Billboards(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features);

    /// Sorts and bins for this view, and uploads. Before any commands of the frame are recorded.
    void prepare(const Camera& camera);

    /// Records one pass over some pixels; the fastest where they begin at multiples of TILE_EDGE.
    void record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawPush& push) const;

    /// Radius of the largest [m].
    double reach() const { return reach_; }
    int tilesAcross() const { return tiles_.across; }

  private:
    gpu::Context& context_;
    const cloud::Cloud& cloud_;
    DrawProgram program_;
    std::vector<float> shares_;  ///< of the collectors
    double reach_ = 0.0;
    TileLists tiles_;
    std::optional<gpu::Image> billboards_, lists_;  ///< of the view that is prepared
    gpu::Buffer offsets_;
};

}  // namespace lumulus::draw
