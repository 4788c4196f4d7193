#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "cloud/asset.h"
#include "gpu/commands.h"
#include "shared/draw.h"

namespace lumulus::light {

/// Where the optical-depth grid lies for one direction of the sun.
struct ShadowGrid {
    glm::ivec3 size{0};
    glm::dmat3 gridToVoxel{1.0};  ///< voxels per texel; the third axis runs along the light
    glm::dvec3 originVoxel{0.0};  ///< middle of texel (0,0,0)
    double spacing = 0.0;         ///< metres between texels along the light
};

/// A grid that covers a box of so many voxels, as fine as its voxels where that stays within `maxTexels`, or
/// `reduction` times as coarse. Texels are cubes, or `across` times as wide across the light; where voxels are not
/// cubes, the grid is sheared along the light and has their shape.
ShadowGrid makeShadowGrid(const glm::ivec3& voxels, const glm::dmat3& voxelToMetres, const glm::dvec3& sunTravel,
                          double maxTexels, int reduction = 1, int across = 1);

/// Optical depth towards the sun through the whole cloud, and no other. Made anew for each direction of the sun; not at
/// all for a scene without one.
class ShadowVolume {
  public:
    /// `voxelToMetres`: edges of a voxel as they lie in the world, of an instance of the cloud. `across`: edge of a
    /// texel across the light, over that along it.
    ShadowVolume(gpu::Context& context, const cloud::Asset& cloud, const glm::dmat3& voxelToMetres, int across = 1);
    ShadowVolume(gpu::Context& context, const cloud::Asset& cloud)
        : ShadowVolume(context, cloud, cloud.voxelToMetres) {}

    /// Records what fills the grid. `extinction` is σt at density 1 [1/m]. The work falls with the third power of
    /// `reduction`.
    void record(gpu::Commands& commands, const glm::dvec3& sunTravel, double extinction, int reduction = 1);

    /// Begins another grid, not reduced, beside the one that is shown.
    void begin(const glm::dvec3& sunTravel, double extinction);
    /// After begin(): records what fills about this share (0 to 1) of that grid. True when that was the rest: it takes
    /// the place of the other, with the same values as record() makes.
    bool recordPart(gpu::Commands& commands, double share);

    /// Valid after record().
    const gpu::Image& image() const { return *shown_.image; }
    const ShadowGrid& grid() const { return shown_.grid; }
    /// Voxel coordinates → texture coordinates of the grid.
    glm::mat3 voxelToTexture() const;
    glm::vec3 textureOffset() const;

  private:
    struct Filled {
        ShadowGrid grid;
        float step = 0.0F;  // optical depth of one texel's length at density 1
        int rows = 0;       // of columns that are filled
        std::optional<gpu::Image> image;
    };

    void lay(Filled& filled, const glm::dvec3& sunTravel, double extinction, int reduction);
    void fill(gpu::Commands& commands, Filled& filled, int rows);

    gpu::Context& context_;
    const cloud::Asset& cloud_;
    const glm::dmat3 voxelToMetres_;
    const int across_;
    gpu::Program<shared::ShadowVolumePush> program_;
    Filled shown_, next_;
};

}  // namespace lumulus::light
