#pragma once

#include <optional>

#include "draw/bands.h"
#include "draw/drawing.h"
#include "draw/instance_tiles.h"
#include "gpu/commands.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::draw {

/// Pixels from one point of a sampling to the next, at most.
constexpr int widestSpacing = 4;

/// How far apart (1, 2 or 4 pixels) the points may lie between which a picture is interpolated: less than the smallest
/// structure, two voxels, each of `voxelPixels` pixels. 1: every pixel is drawn.
int samplingSpacing(double voxelPixels);

/// Whether blocks that cannot be interpolated are sampled at half the spacing before they are drawn pixel by pixel.
bool hasRefinement(int spacing);

/// Part of the time of drawing every pixel that the points and what is not smooth between them take, on the safe side:
/// .18 to .3 were measured for 4 before it had refined, less since.
double drawnShare(int spacing);

/// Points that a tile needs: one more around its blocks, within the picture; two more below and on the right with
/// refined. `tolerance`: the largest second difference from point to point, against the brightest around; distances may
/// by eight voxels (edge [m]).
shared::SamplingGrid samplingGridOf(const Camera& camera, const Tile& tile, int spacing, double tolerance,
                                    double voxelLength);

/// Rows of sampling points (from the sampling's first) that a band of a tile looks at.
Band samplingRows(const shared::SamplingGrid& sampling, const Tile& tile, const Band& band);

/// Draws the pixels between the points of a sampling, or lists squares of them that are to be drawn as they are. The
/// order is record(), with refined refinedPoints() by blocks() into refined() and recordRefined(), then
/// squares() by lastList().
class Interpolation {
  public:
    /// `many`: of several clouds, whose tiles differ in detail.
    Interpolation(gpu::Context& context, int spacing, bool many);

    /// Makes room for bands of so many rows of pixels; before commands are recorded.
    void prepare(const shared::SamplingGrid& sampling, int bandRows);
    /// Empty lists; before commands are recorded.
    void clearLists();
    /// Records the pass over a rectangle of pixels.
    void record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                const Tile& pixels) const;
    /// Records the pass over what the first one listed.
    void recordRefined(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                       const Tile& pixels) const;

    /// What draws the refined points of blocks(), and the squares that are listed last.
    shared::DrawPush refinedPoints(const Tile& pixels) const;
    shared::DrawPush squares(const Tile& pixels) const;

    const gpu::Buffer& points() const { return points_; }    ///< a Pixel each
    const gpu::Buffer& refined() const { return refined_; }  ///< of a band, a Pixel each
    const gpu::Buffer& blocks() const { return blocks_; }
    const gpu::Buffer& lastList() const { return hasRefinement(spacing_) ? cells_ : blocks_; }

  private:
    shared::InterpolatePush push(const Tile& pixels) const;

    gpu::Context& context_;
    int spacing_;
    gpu::Program<shared::InterpolatePush> program_;
    std::optional<gpu::Program<shared::InterpolatePush>> refinedProgram_;
    shared::SamplingGrid sampling_{};
    std::uint64_t blocksInBand_ = 0;
    gpu::Buffer points_, refined_;
    gpu::Buffer blocks_, cells_;  ///< groups (3), count, then squares
};

/// A list of squares that is never read, for drawing passes without a sampling.
gpu::Buffer noSquares(gpu::Context& context);

}  // namespace lumulus::draw
