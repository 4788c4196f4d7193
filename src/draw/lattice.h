#pragma once

#include "draw/bands.h"
#include "draw/camera.h"
#include "draw/frame.h"
#include "draw/picture_view.h"
#include "gpu/commands.h"

namespace lumulus::draw {

/// Pixels from one point of a lattice to the next, at most.
constexpr int widestSpacing = 4;

/// How far apart (1, 2 or 4 pixels) the points may lie between which a picture is interpolated: less than the smallest
/// structure, two voxels, each of `voxelPixels` pixels. 1: every pixel is drawn.
int latticeSpacing(double voxelPixels);

/// Part of the time of drawing every pixel that the points and what is not smooth between them take, on the safe side:
/// .18 to .3 were measured for 4.
double drawnShare(int spacing);

/// Points that a tile needs: one more around its blocks, within the picture. `tolerance`: what may bend from point to
/// point, against the brightest around; distances may by eight voxels (edge [m]).
shared::LatticeParams latticeOf(const Camera& camera, const Tile& tile, int spacing, double tolerance,
                                double voxelLength);

/// Rows of lattice points (from the lattice's first) that a band of a tile looks at.
Band latticeRows(const shared::LatticeParams& lattice, const Tile& tile, const Band& band);

/// Draws the pixels between the points of a lattice, or lists the blocks of them that are to be drawn as they are.
class Interpolation {
  public:
    explicit Interpolation(gpu::Context& context);

    /// Makes room for a lattice; before commands are recorded.
    void prepare(const shared::LatticeParams& lattice);
    /// An empty list of blocks; before commands are recorded.
    void clearBlocks();
    /// Records the pass over a rectangle of pixels (push.first, push.count). `inputs.blocks` is blocks().
    void record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawPush& push) const;

    const gpu::Buffer& points() const { return points_; }
    const gpu::Buffer& blocks() const { return blocks_; }

  private:
    gpu::Context& context_;
    gpu::Program<shared::DrawPush> program_;
    shared::LatticeParams lattice_{};
    gpu::Buffer points_;  ///< a Pixel each
    gpu::Buffer blocks_;  ///< groups (3), count, then indices
};

/// A list of blocks that is never read, for drawing passes without a lattice.
gpu::Buffer noBlocks(gpu::Context& context);

}  // namespace lumulus::draw
