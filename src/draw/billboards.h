#pragma once

#include <span>
#include <vector>

#include "cloud/instance.h"
#include "draw/drawing.h"
#include "draw/tiles.h"
#include "gpu/commands.h"
#include "shared/draw.h"
#include "view/camera.h"

namespace lumulus::draw {

/// One billboard a collector of each instance (all have assets), relative to the eye, nearest first (ties by instance
/// and index). `shares`: of each instance's collectors, see billboardShares().
std::vector<shared::Billboard> makeBillboards(std::span<const cloud::Instance* const> instances,
                                              std::span<const std::vector<float>> shares, const Camera& camera);

/// Draws clouds as billboards into bands of pixels.
class Billboards {
  public:
    /// `instances` have assets and outlive it.
    Billboards(gpu::Context& context, std::span<const cloud::Instance* const> instances, const DrawFeatures& features);

    class View;
    /// Records one pass over some pixels; the fastest where they begin at multiples of TILE_EDGE.
    void record(gpu::Commands& commands, const DrawInputs& inputs, const View& view,
                const shared::DrawPush& push) const;

    /// Radius of the largest of an instance [m].
    double reach(std::size_t instance) const { return reach_[instance]; }

    /// The billboards as one camera sees them, sorted and binned in tiles.
    class View {
      public:
        /// Uploads; before any commands of the frame are recorded.
        View(gpu::Context& context, const Billboards& billboards, const Camera& camera);

        int tilesAcross() const { return tiles_.across; }

      private:
        friend class Billboards;
        View(gpu::Context& context, const std::vector<shared::Billboard>& billboards, const Camera& camera);

        TileLists tiles_;
        gpu::Image billboards_, lists_;
        gpu::Buffer offsets_;
    };

  private:
    std::size_t firstWith(const cloud::Asset* asset) const;

    std::vector<const cloud::Instance*> instances_;
    DrawProgram program_;
    std::vector<std::vector<float>> shares_;  ///< of the collectors of each instance
    std::vector<double> reach_;
};

}  // namespace lumulus::draw
