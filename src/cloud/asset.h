#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "cloud/kdtree.h"
#include "gpu/memory.h"
#include "gpu/program.h"
#include "scene/scene.h"
#include "vdb/placed_volume.h"
#include "vdb/quantise.h"
#include "vdb/sparse_volume.h"

namespace lumulus::cloud {

/// Majorants of the normalised density on a coarse grid, for delta tracking. One cell is a global majorant.
struct MajorantGrid {
    glm::ivec3 cells{1};
    glm::vec3 cellSize{1.0F};  ///< voxels
    std::vector<float>
        maxima;  ///< cells.x·cells.y·cells.z, x fastest; never below any interpolated density of the cell
    double nullCollisions = 0.0;  ///< expected for each real one, for light that fills the box evenly
};

/// Cubic cells over the voxels, x fastest.
struct CellGrid {
    int edge = 0;  ///< of a cell, voxels; 0: no grid
    glm::ivec3 cells{0};

    std::uint64_t count() const {
        return static_cast<std::uint64_t>(cells.x) * static_cast<std::uint64_t>(cells.y) *
               static_cast<std::uint64_t>(cells.z);
    }
    bool operator==(const CellGrid&) const = default;
};

/// A virtual photon collector (VPC) and the billboard that stands for its leaf.
struct Collector {
    glm::vec3 centre{0.0F};  ///< of mass, voxel coordinates
    float mass = 0.0F;       ///< ∫ normalised density over the leaf [voxels]
    float majorant = 0.0F;   ///< of the normalised density in the leaf
    float occupied = 0.0F;   ///< fraction of the leaf's voxels that have density
    shared::LeafBox box;

    /// Voxels of the leaf that have density.
    double occupiedVoxels() const {
        const glm::dvec3 extent(box.upper - box.lower);
        return static_cast<double>(occupied) * extent.x * extent.y * extent.z;
    }
};

/// Seconds of each step of the preparation, for --stats and benchmarks.
struct PreparationTimes {
    double upload = 0.0;     ///< density
    double majorants = 0.0;  ///< with the bounds of the gradient
    double sampling = 0.0;
    double tree = 0.0;
    double collectors = 0.0;  ///< with the collector of each voxel
};

/// What one density field needs once: prepared for photons and drawing, immutable, on the GPU once, shared by all
/// instances that show it. It knows the shape of its voxels and not where in the world it stands.
struct Asset {
    glm::ivec3 size{0};        ///< voxels
    glm::dmat3 voxelToMetres;  ///< edges of a voxel as they lie in the world, columns [m]
    double voxelVolume = 0.0;  ///< m³
    vdb::DensityFormat format = vdb::DensityFormat::r16f;
    /// Normalised: 1 is the field's maximum. All voxels, or a pool of bricks, which other assets have slots in too.
    std::shared_ptr<const gpu::Image> density;
    std::optional<gpu::Image> bricks;  ///< the index of the density's bricks (lib/bricks.glsl); none where it is dense
    /// Number of the collector of each voxel, the format's largest value: none. Of bricks: nodes of the kD-tree
    /// (lib/collector.glsl).
    gpu::Image collectorIndex;
    MajorantGrid majorants;  ///< that photons walk through: a single one or one a cell
    gpu::Image majorantImage;
    MajorantGrid blocks;                  ///< one a block or brick; only where PrepareOptions asks for it
    MajorantGrid cells;                   ///< one a cell always: where a march finds empty space
    std::optional<gpu::Image> cellImage;  ///< none where photons walk through the same cells
    std::vector<Sample> samples;
    KdTree tree;
    std::vector<Collector> collectors;
    PreparationTimes times;

    const gpu::Image& marchedCells() const { return cellImage ? *cellImage : majorantImage; }
    bool isSparse() const { return bricks.has_value(); }
    /// What shaders are given as `bricks`; any image of integers where there are none.
    const gpu::Image& brickIndex() const { return bricks ? *bricks : collectorIndex; }
    /// What every program that looks density up is made with.
    gpu::SpecConstant sparseConstant() const { return gpu::SpecConstant::of(15, isSparse()); }
};

struct PrepareOptions {
    scene::Preparation preparation;
    scene::Majorant majorant = scene::Majorant::automatic;
    double reducedExtinction = 0.0;  ///< σt'(1−g') at the field's maximum [1/m]
    std::uint32_t seed = 1;
    bool keepBlocks = false;          ///< whether the asset keeps the majorants of blocks, for cloud::mergeGrids()
    Check check = stopIfInterrupted;  ///< asked between pieces of the work, by several threads at once
};

/// Steps 1 to 5 of the preparation: gradient, samples, kD-tree, leaf statistics, collectors. The volume must not
/// be empty. Errors: what the check throws.
Asset prepare(gpu::Context& context, const vdb::PlacedVolume& placed, const PrepareOptions& options);

/// The same for a field in bricks, whose texels lie in `pool` already (makePool); `toWorld`: where the cloud has it.
Asset prepareBricks(gpu::Context& context, const vdb::SparseVolume& volume, const vdb::Affine& toWorld,
                    std::shared_ptr<const gpu::Image> pool, const PrepareOptions& options);

/// What the GPU reads: the majorant of each cell, or where that is 0, −d with d the Chebyshev distance, in cells, to
/// the nearest cell with a majorant (the sum of the grid's edges where there is none). A walk may cross all cells
/// nearer than d at once.
std::vector<float> majorantsAndDistances(const MajorantGrid& grid);

/// Majorants on cells of `edge` blocks, or a single one for the whole volume (edge 0), from those of the blocks.
MajorantGrid majorantGrid(const std::vector<float>& blockMaxima, const glm::ivec3& blocks, const glm::ivec3& size,
                          int edge, double mass);

/// Those of bricks, which fillSlots() has made; `global`: a single one.
MajorantGrid majorantGrid(const vdb::SparseVolume& volume, bool global, double mass);

}  // namespace lumulus::cloud
