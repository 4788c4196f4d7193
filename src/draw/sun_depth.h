#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "cloud/cloud.h"
#include "gpu/commands.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// Where the optical-depth grid lies for one direction of the sun.
struct SunGrid {
    glm::ivec3 size{0};
    glm::dmat3 gridToVoxel{1.0};  ///< voxels per texel; the third axis runs along the light
    glm::dvec3 originVoxel{0.0};  ///< middle of texel (0,0,0)
    double spacing = 0.0;         ///< metres between texels
};

/// A grid that covers the cloud's box, as fine as its voxels where that stays within `maxTexels`.
SunGrid makeSunGrid(const cloud::Cloud& cloud, const glm::dvec3& sunTravel, double maxTexels);

/// Optical depth towards the sun through the whole cloud. Made anew for each direction of the sun; not at all for a
/// scene without one.
class SunDepth {
  public:
    SunDepth(gpu::Context& context, const cloud::Cloud& cloud);

    /// Records what fills the grid. `extinction` is σt at density 1 [1/m].
    void record(gpu::Commands& commands, const glm::dvec3& sunTravel, double extinction);

    /// Valid after record().
    const gpu::Image& image() const { return *image_; }
    /// Voxel coordinates → texture coordinates of the grid.
    glm::mat3 voxelToTexture() const { return voxelToTexture_; }
    glm::vec3 textureOffset() const { return textureOffset_; }

  private:
    gpu::Context& context_;
    const cloud::Cloud& cloud_;
    gpu::Program<shared::SunDepthPush> program_;
    std::optional<gpu::Image> image_;
    glm::mat3 voxelToTexture_{1.0F};
    glm::vec3 textureOffset_{0.0F};
};

}  // namespace lumulus::draw
