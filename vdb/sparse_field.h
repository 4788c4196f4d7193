#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
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
    float* leaf = nullptr;  ///< 8³ values, z fastest, owned by the tree; null for a tile
    float tile = 0.0F;

    float valueAt(const glm::ivec3& at) const {
        if (leaf == nullptr) return tile;
        const glm::ivec3 local = at - box.minimum;
        return leaf[(local.x * leafEdge + local.y) * leafEdge + local.z];
    }
};

/// A field of blocks that do not overlap. Voxels outside of all blocks are 0.
struct SparseField {
    std::vector<Block> blocks;
};

/// The box that both boxes share.
inline IndexBox intersect(const IndexBox& a, const IndexBox& b) {
    return {glm::max(a.minimum, b.minimum), glm::min(a.maximum, b.maximum)};
}

/// Extends `box` so that it holds `other`, which is not empty.
inline void include(IndexBox& box, const IndexBox& other) {
    box = box.empty() ? other : IndexBox{glm::min(box.minimum, other.minimum), glm::max(box.maximum, other.maximum)};
}

/// Calls `visit(coordinate)` for the voxels of a box in lexicographic order.
template <typename Visit>
void forEachVoxel(const IndexBox& box, const Visit& visit) {
    // 64-bit counters: a box may end at the largest int
    for (std::int64_t x = box.minimum.x; x <= box.maximum.x; ++x)
        for (std::int64_t y = box.minimum.y; y <= box.maximum.y; ++y)
            for (std::int64_t z = box.minimum.z; z <= box.maximum.z; ++z) visit(glm::ivec3(glm::i64vec3(x, y, z)));
}

/// The smallest n for which boxes of n³ voxels, with a ring, fit both limits; 0 if even one voxel does not.
/// `budget`: bytes, at 2 a voxel. `maxExtent`: voxels along a side.
std::int64_t chooseCoarsening(const glm::i64vec3& extent, double budget, int maxExtent);

/// Voxels along each side of `extent` in boxes of n³, without the ring.
glm::ivec3 coarseSize(const glm::i64vec3& extent, std::int64_t n);

/// The field over `crop` as averages over boxes of n³ voxels that start at its minimum (n = 1: the values themselves),
/// with a ring of zeros. Fills size, density and maximum. Values outside of `crop` count as zero.
/// Errors: what `check` throws.
Volume rasteriseField(const SparseField& field, const IndexBox& crop, std::int64_t n, const Check& check);

}  // namespace lumulus::vdb
