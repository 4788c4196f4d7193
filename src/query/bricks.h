#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "vdb/sparse_volume.h"
#include "vdb/volume.h"

namespace lumulus::query {

/// A straight line in the voxel coordinates of a field: start + velocity · metres.
struct VoxelLine {
    glm::dvec3 start{0.0};
    glm::dvec3 velocity{0.0};
};

/// The index of a field in bricks, as vdb::SparseVolume has it.
struct BrickIndex {
    glm::ivec3 size{0};                        ///< voxels
    std::span<const std::uint32_t> nodes;      ///< of each 4³ bricks, x fastest
    std::span<const vdb::BrickEntry> entries;  ///< 64 for each node
};

/// Gives the 9³ texels (0 to 1, x fastest) of the slot that lies at a place of the pool (vdb::slotPlace).
using SlotReader = std::function<void(std::uint32_t place, std::span<float, vdb::SparseVolume::slotTexels> texels)>;

/// A density field for integrals along lines: trilinear between the centres of voxels, as every renderer here sees it.
/// The field is cut into bricks of 8³ cells between voxel centres; each holds the 9³ values at their corners as 16-bit
/// numbers between its least and its largest value. A brick of one value holds none. Bricks of a coarser level l share
/// values that are 2^l voxels apart.
class BrickField {
  public:
    BrickField() = default;
    /// `volume` is as its loader made it: its outermost voxels are zero. Errors: what `check` throws.
    explicit BrickField(const vdb::Volume& volume, const Check& check = stopIfInterrupted);
    /// A field that is in bricks already. Errors: what `read` and `check` throw.
    BrickField(const BrickIndex& index, const SlotReader& read, const Check& check = stopIfInterrupted);
    /// The same with the texels of `volume`, which are made here; the density is of the volume's maximum. Errors: those
    /// of reading leaves.
    explicit BrickField(vdb::SparseVolume& volume, const Check& check = stopIfInterrupted);

    const glm::ivec3& size() const { return size_; }  ///< voxels
    /// All voxels, for what does not know bricks; at its own place. None where some bricks are coarser. Errors: what
    /// `check` throws.
    std::optional<vdb::Volume> volume(const Check& check = stopIfInterrupted) const;
    std::uint64_t bytes() const;

    /// ∫ density dt along the line between two distances [m], 0 where `begin` is not below `end`. Between planes of
    /// voxel centres the density is a cubic polynomial of the distance, which Gauss's two points integrate exactly.
    double integral(const VoxelLine& line, double begin, double end) const;

    /// The distance between `begin` and `end` at which that integral has grown to `wanted`; infinite where it stays
    /// below. Within a cell the density is taken for linear.
    double reach(const VoxelLine& line, double begin, double end, double wanted) const;

    /// Clips a part of a line to where the field is. Returns false where nothing is left.
    bool clip(const VoxelLine& line, double& begin, double& end) const;

  private:
    /// The density is low + step · value.
    struct Brick {
        std::uint32_t values = 0;  ///< number of its values in the pool
        float low = 0.0F;
        float step = 0.0F;  ///< 0: no values, the density is `low`
        int level = 0;
    };

    std::size_t entryOf(const glm::ivec3& brick) const;
    /// Over a part of the line within one brick; the line's coordinates count from the middle of voxel 0.
    double brickIntegral(const glm::ivec3& number, const VoxelLine& line, double length) const;
    /// As reach(), within one brick whose integral is `wanted` or more.
    double brickReach(const glm::ivec3& number, const VoxelLine& line, double length, double wanted) const;
    /// Goes from brick to brick: `visit(number, line, begin, length)` has the line from there on, counted from the
    /// middle of voxel 0, and returns whether to go on.
    template <typename Visit>
    void visitBricks(const VoxelLine& line, double begin, double end, const Visit& visit) const;
    /// Goes from cell to cell within a brick that has values: `visit(begin, span, near, far)` has the values at Gauss's
    /// two points, over the brick's step, and returns whether to go on.
    template <typename Visit>
    void visitCells(const Brick& brick, const glm::ivec3& number, const VoxelLine& line, double length,
                    const Visit& visit) const;

    glm::ivec3 size_{0};
    glm::ivec3 count_{0};               ///< bricks along x, y, z
    std::vector<std::uint32_t> nodes_;  ///< number of the node of each 4³ bricks; 0 is that of empty ones
    std::vector<Brick> bricks_;         ///< 64 for each node
    std::vector<std::uint16_t> pool_;
};

}  // namespace lumulus::query
