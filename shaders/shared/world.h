// Interface structs of a photon walk through several clouds. What differs from cloud to cloud is read as texels, which
// lavapipe loads by vectors; numbers in them are floats, exact below 2²⁴, or the bits of integers.
#ifndef LUMULUS_SHARED_WORLD_H
#define LUMULUS_SHARED_WORLD_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Cells along the edge of a brick of the merged grid, and in it.
const int MERGED_BRICK = 8;
const int MERGED_BRICK_CELLS = MERGED_BRICK * MERGED_BRICK * MERGED_BRICK;
/// What stands for a brick without cells: this plus the distance in bricks to the nearest one that has some.
const uint EMPTY_BRICK = 0x80000000U;
/// The list of a cell in which there is one instance: this plus its number. Others: where its list begins, with the
/// count.
const uint SINGLE_INSTANCE = 0x80000000U;

/// The grid of all clouds together, and where photons begin.
struct MergedGridParams {
    ivec3 bricks;
    uint instances;
    float edge;           // of a cell [m]
    float largestWeight;  // [m²] that a photon may stand for
    ivec3 entryCells;     // of the grid that photons begin in (photon/entry_grid.h)
    float entryEdge;      // of one of them [m]
    uint starts;          // photons that an invocation may begin in a round
};

/// A cloud that photons walk through: eleven texels.
struct WalkedInstance {
    vec4 toVoxel[3];   // rows, from cells of the merged grid beyond `base` to voxels; w: the voxel at `base`
    vec3 size;         // voxels
    float extinction;  // collision coefficient at density 1 [1/m]: σt(1 − f·min albedo)
    vec3 volume;       // first texel in the atlas; of bricks: first texels of the indices of bricks and of collectors
    float phaseTable;  // where its inverse CDF begins; negative: Henyey–Greenstein
    vec3 base;         // cell
    float asymmetry;   // g
    vec3 albedo;
    float scatterShare;     // probability that a collision is a scattering event
    vec3 straightWeight;    // of light that goes straight on at a collision
    float scatterFraction;  // 1 − f
    vec3 sunShare;          // of the sun's light that reaches the instance
    float estimatorEdge;    // voxels; 0: no cells
    vec3 estimatorCells;
    uint estimatorBase;
    uint firstCollector;
    uint collectors;
    vec2 unused;
};
const int WALKED_TEXELS = 11;

/// An ellipsoid that holds a cloud, round which photons begin: eight texels. Lengths are metres from the corner of the
/// grid.
struct EntryDisc {
    vec4 sphere;       // round it: middle and radius
    vec4 toUnit[3];    // rows: from a place to the unit sphere; w: of the grid's corner
    vec4 fromUnit[3];  // rows; w: the middle
    float volume;  // π times the determinant of `fromUnit` [m³]: over the length of a direction in it, the area seen
    float share;   // probability that a photon begins here
    float keep;    // of the alias table: probability that its entry stands for itself
    float other;   // and whom it stands for else
};
const int ENTRY_TEXELS = 8;

/// Where a photon begins: three texels. What an invocation begins with in a round lies `invocations` apart.
struct PhotonStart {
    vec4 place;      // cells of the merged grid; w: weight of red
    vec4 direction;  // w: weight of green
    vec4 rest;       // x: weight of blue
};
const int START_TEXELS = 3;

#ifdef __cplusplus
static_assert(sizeof(PhotonStart) == 16 * START_TEXELS && offsetof(PhotonStart, rest) == 32);
static_assert(sizeof(MergedGridParams) == 44 && offsetof(MergedGridParams, starts) == 40);
static_assert(sizeof(WalkedInstance) == 16 * WALKED_TEXELS && offsetof(WalkedInstance, unused) == 168);
static_assert(sizeof(EntryDisc) == 16 * ENTRY_TEXELS && offsetof(EntryDisc, other) == 124);
#endif

SHARED_END

#endif
