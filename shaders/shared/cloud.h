// Interface structs of the cloud: its volume on the GPU and the passes of the preparation.
#ifndef LUMULUS_SHARED_CLOUD_H
#define LUMULUS_SHARED_CLOUD_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Edge, in voxels, of the blocks over which gradient bounds and base majorants are taken.
const int BLOCK_EDGE = 4;

/// One box of whole voxels [lower, upper): a leaf of the kD-tree.
struct LeafBox {
    ivec3 lower;
    ivec3 upper;
};

/// What the leaf pass finds, in units of the normalised density (maximum 1) and voxels.
struct LeafStatistics {
    float majorant;  // largest texel that trilinear interpolation inside the leaf can see
    float mass;      // integral of the interpolated density over the leaf [voxels]
    vec3 moment;     // integral of density · (position − lower) [voxels²]
    float occupied;  // fraction of voxels with density
};

struct BlockPush {
    ivec3 size;             // voxels
    ivec3 blocks;           // blocks along each axis
    mat3 gradientToMetres;  // (voxel → world)⁻ᵀ: takes a gradient per voxel into one per metre
};

struct SamplePush {
    mat3 gradientToMetres;
    ivec3 size;
    ivec3 blocks;
    uint samples;
    uint seed;
};

struct LeafPush {
    ivec3 size;
    uint leaves;
};

/// Texels of an index of bricks, and where they go.
struct CopyIndexPush {
    uint count;
    uint first;
};

#ifdef __cplusplus
// Scalar layout, as SPIR-V has it; tests/unit/shared_layout_test.cpp compares every member.
static_assert(sizeof(LeafBox) == 24 && offsetof(LeafBox, upper) == 12);
static_assert(sizeof(LeafStatistics) == 24 && offsetof(LeafStatistics, occupied) == 20);
static_assert(sizeof(BlockPush) == 60 && offsetof(BlockPush, gradientToMetres) == 24);
static_assert(sizeof(SamplePush) == 68 && offsetof(SamplePush, seed) == 64);
static_assert(sizeof(CopyIndexPush) == 8 && offsetof(CopyIndexPush, first) == 4);
static_assert(sizeof(LeafPush) == 16 && offsetof(LeafPush, leaves) == 12);
#endif

SHARED_END

#endif
