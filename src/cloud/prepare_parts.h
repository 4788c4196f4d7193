#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "base/interrupt.h"
#include "cloud/asset.h"

/// Steps of the preparation that dense fields and those in bricks share (inside cloud/ only).
namespace lumulus::cloud {

/// Times the steps of the preparation, and asks whether to go on between two of them.
class StepWatch {
  public:
    explicit StepWatch(const Check& check) : check_(check) {}

    double lap() {
        check_();
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

  private:
    const Check& check_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Takes a gradient per voxel into one per metre.
glm::mat3 gradientToMetres(const glm::dmat3& voxelToMetres);

/// Cubes of voxels, one after the other, with bounds of what is in them.
struct Blocks {
    glm::ivec3 count{0};                ///< along each axis
    std::vector<float> majorants;       ///< of the density
    std::vector<float> gradientBounds;  ///< of |∇ρ|
    std::vector<glm::ivec3> places;  ///< where the blocks are bricks: of each, in bricks; `count` is then their number
    int edge = shared::BLOCK_EDGE;   ///< voxels

    /// Of those with density.
    double occupiedVoxels() const;
};

/// What the density is found by.
struct DensityImages {
    const gpu::Image& density;
    const gpu::Image& bricks;  ///< any image of integers where the density is dense
};

std::vector<Sample> sampleGradient(gpu::Context& context, const gpu::Program<shared::SamplePush>& program,
                                   const DensityImages& images, const glm::ivec3& size, const Blocks& blocks,
                                   const glm::mat3& toMetres, const PrepareOptions& options);

/// The kD-tree over the samples. `density` need not outlive this.
KdTree makeTree(const std::vector<Sample>& samples, const glm::ivec3& size, const BlockDensity& density,
                const glm::dmat3& voxelToMetres, const Blocks& blocks, const PrepareOptions& options);

std::vector<shared::LeafStatistics> leafStatistics(gpu::Context& context, const gpu::Program<shared::LeafPush>& program,
                                                   const DensityImages& images, const glm::ivec3& size,
                                                   const gpu::Buffer& leafBuffer, std::uint32_t leaves);

/// One collector for each leaf that has mass; `numbers` receives the collector of each leaf, NO_COLLECTOR for the rest.
std::vector<Collector> makeCollectors(const KdTree& tree, const std::vector<shared::LeafStatistics>& statistics,
                                      std::vector<std::uint32_t>& numbers);

/// Integral of the normalised density [voxels].
double massOf(const std::vector<Collector>& collectors);

/// Whether photons walk through cells rather than through one majorant.
bool isLocal(scene::Majorant wanted, const MajorantGrid& single);

gpu::Image majorantImage(gpu::Context& context, const MajorantGrid& grid);

/// Of the image of a dense field.
VkFormat formatOf(vdb::DensityFormat format);

/// The collector of each voxel of a dense field. `leafBuffer` has the leaves, `numbers` the collector of each.
gpu::Image indexCollectors(gpu::Context& context, const gpu::Program<shared::LeafPush>& program, const glm::ivec3& size,
                           const gpu::Buffer& leafBuffer, const std::vector<std::uint32_t>& numbers,
                           std::size_t collectors);

}  // namespace lumulus::cloud
