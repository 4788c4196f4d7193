#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "vdb/volume.h"

/// A sparse density field as plain values, between the OpenVDB tree and the dense volume (inside vdb/ only).
namespace lumulus::vdb {

/// A box of index coordinates, both ends included. Its extent needs 64 bits.
struct IndexBox {
    glm::ivec3 minimum{0};
    glm::ivec3 maximum{-1};

    bool empty() const { return glm::any(glm::lessThan(maximum, minimum)); }
    glm::i64vec3 extent() const { return glm::i64vec3(maximum) - glm::i64vec3(minimum) + std::int64_t{1}; }
};

/// Part of the field: a box of one value (a tile) or an 8³ leaf of values.
struct Block {
    static constexpr int leafEdge = 8;
    IndexBox box;
    const float* leaf = nullptr;  ///< 8³ values, z fastest; null for a tile
    float tile = 0.0F;
};

/// A field of blocks that do not overlap. Voxels outside of all blocks have the background's value. Only voxels in
/// `bounds` count.
struct SparseField {
    std::vector<Block> blocks;
    float background = 0.0F;
    IndexBox bounds;
};

/// A value that is no density, at an index coordinate.
struct BadValue {
    glm::ivec3 at{0};
    float value = 0.0F;
};

struct Survey {
    IndexBox occupied;            ///< around all nonzero values; empty if there are none
    std::optional<BadValue> bad;  ///< the one with the lexicographically smallest coordinate
};

/// Visits every value within the bounds once. Errors: Error if interrupted.
Survey surveyField(const SparseField& field);

/// The smallest n for which boxes of n³ voxels, with a ring, fit both limits; 0 if even one voxel does not.
/// `budget`: bytes, at 2 a voxel. `maxExtent`: voxels along a side.
std::int64_t chooseCoarsening(const glm::i64vec3& extent, double budget, int maxExtent);

/// Voxels along each side of `extent` in boxes of n³, without the ring.
glm::ivec3 coarseSize(const glm::i64vec3& extent, std::int64_t n);

/// The field over `crop` as averages over boxes of n³ voxels that start at its minimum (n = 1: the values themselves),
/// with a ring of zeros. Fills size, density and maximum. Values outside of `crop` count as zero.
/// Errors: Error if interrupted.
Volume rasteriseField(const SparseField& field, const IndexBox& crop, std::int64_t n);

}  // namespace lumulus::vdb
