#pragma once

#include <optional>
#include <vector>

#include "cloud/atlas.h"
#include "cloud/bricks.h"
#include "draw/bands.h"
#include "draw/billboards.h"
#include "draw/drawing.h"
#include "draw/march.h"
#include "render/gpu_work.h"
#include "render/view_state.h"
#include "render/world.h"
#include "scene/scene.h"

namespace lumulus {

/// Rays along each side of a pixel that an instance needs: more than one where voxels are smaller than pixels.
int raysOf(const World& world, std::size_t instance, const Camera& camera);

/// Draws the clouds of a world: the programs of the scene's way to draw, and what they bind that no view changes.
class Painter {
  public:
    /// Errors: InputError where the device cannot hold the volumes of all clouds in one image.
    /// `meshes`: whether the scene has some.
    Painter(gpu::Context& context, const World& world, const scene::Draw& draw, bool meshes);

    /// Spacing in pixels of the points of sparse sampling for a view, chosen so that the farthest voxels still cover
    /// it; of several clouds the widest, as tiles with smaller voxels are drawn more finely (findShown()).
    int samplingSpacing(const World& world, const Camera& camera) const;
    /// The part of the view's tile in which clouds may be seen. Voxels reach half a voxel farther than their bounds,
    /// billboards as far as the largest.
    Tile shownPart(const World& world, const ViewState::State& view) const;

    /// Finds which pixels may show which instance, and whether sampling pays, before lightView(), which leaves out what
    /// is not seen.
    void findShown(gpu::Context& context, const World& world, ViewState::State& view) const;
    /// Sorts and uploads what the camera of the view needs, after lightView() and before paint().
    void prepare(GpuWork& work, ViewState::State& view) const;
    /// Draws bands of rows of the shown part into `image`, or into the view's frame where `image` is null.
    void paint(GpuWork& work, const World& world, ViewState::State& view, const std::vector<draw::Band>& bands,
               LayeredImage* image, const Check& check, const Report& report) const;

  private:
    /// What one picture's passes bind.
    struct Picture;

    /// How finely each of visible_ is to be drawn, with `mostRays` along a side of a pixel.
    std::vector<draw::Fineness> fineness(const World& world, const Camera& camera, int mostRays) const;
    draw::Volumes volumes(const World& world, const ViewState::State& view, const gpu::Image& sunColours,
                          const gpu::Image& skyReturn) const;
    shared::InstanceParams instanceParams(const World& world, const ViewState::State& view, std::size_t place) const;
    shared::DrawParams drawParams(const World& world, const ViewState::State& view) const;
    void fillAtlas(GpuWork& work, ViewState::State& view) const;
    void recordPixels(gpu::Commands& commands, const draw::DrawInputs& inputs, const ViewState::State& view,
                      const draw::MeshBuffers* meshes, const shared::DrawPush& push) const;
    void recordBlocks(gpu::Commands& commands, const draw::DrawInputs& inputs, ViewState::State& view,
                      const shared::SamplingGrid& sampling, const draw::Band& band, const Tile& pixels) const;
    void paintBand(GpuWork& work, const draw::DrawInputs& inputs, ViewState::State& view,
                   const shared::SamplingGrid& sampling, const draw::Band& band, LayeredImage* image) const;

    double tolerance_;
    std::vector<std::size_t> visible_;  ///< numbers of the instances that are drawn, in the order of the GPU's list
    std::vector<int> phaseTables_;      ///< of each of them
    draw::DrawFeatures features_;
    draw::PhaseTables phase_;
    std::optional<draw::Billboards> billboards_;
    std::optional<draw::March> march_;
    gpu::Image none_;  ///< stands for what the scene does not have: shaders never read it, but bindings must be there
    gpu::Image noColours_;
    gpu::Buffer noSquares_;
    draw::InstanceTiles noTiles_;  ///< for the one instance
};

}  // namespace lumulus
