#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
#include "vdb/volume.h"

namespace lumulus::query {

/// A straight line in the voxel coordinates of a field: start + velocity · metres.
struct VoxelLine {
    glm::dvec3 start{0.0};
    glm::dvec3 velocity{0.0};
};

/// A density field for integrals along lines: trilinear between the centres of voxels, as every renderer here sees it.
/// The field is cut into bricks of 8³ cells between voxel centres; each holds the 9³ values at their corners as 16-bit
/// numbers, in units of 1/65535 of its largest value, and a brick without density holds none.
class BrickField {
  public:
    BrickField() = default;
    /// `volume` is as its loader made it: its outermost voxels are zero. Errors: what `check` throws.
    explicit BrickField(const vdb::Volume& volume, const Check& check = stopIfInterrupted);

    const glm::ivec3& size() const { return size_; }  ///< voxels
    std::uint64_t bytes() const;

    /// ∫ density dt along the line between two distances [m], 0 where `begin` is not below `end`. Between planes of
    /// voxel centres the density is a cubic polynomial of the distance, which Gauss's two points integrate exactly.
    double integral(const VoxelLine& line, double begin, double end) const;

  private:
    struct Brick {
        std::uint32_t values = 0;  ///< number of its values in the pool
        float unit = 0.0F;         ///< density of one step; 0: nothing is in the brick
    };

    void fill(const vdb::Volume& volume, const glm::ivec3& corner, Brick& brick, std::uint16_t* values) const;
    double brickIntegral(const Brick& brick, const glm::dvec3& start, const glm::dvec3& velocity, double length) const;

    glm::ivec3 size_{0};
    glm::ivec3 count_{0};  ///< bricks along x, y, z
    std::vector<Brick> bricks_;
    std::vector<std::uint16_t> pool_;
};

}  // namespace lumulus::query
