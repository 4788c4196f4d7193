// Interface structs of the photon map: the walk, its records and the passes that collect them.
#ifndef LUMULUS_SHARED_PHOTON_H
#define LUMULUS_SHARED_PHOTON_H

#include "shared/air_light.h"
#include "shared/prelude.h"

SHARED_BEGIN

/// Photon power in records is an integer of this many units at most (of 2²¹; the rest is headroom for the sun's disc).
const float POWER_UNITS = 1048576.0F;
/// Fraction bits of y_lm · power in the integers that collectors add: |sum| of 64 records stays below 2³¹.
const float COEFFICIENT_SCALE = 8.0F;
/// Records that one invocation of the gather pass adds up.
const uint GATHER_CHUNK = 64U;
const uint NO_COLLECTOR = 0xFFFFFFFFU;
/// Texels in a row of an image that has one for each collector.
const uint COLLECTORS_WIDTH = 4096U;

SHARED_FN ivec2 collectorTexel(uint collector) {
    return ivec2(collector % COLLECTORS_WIDTH, collector / COLLECTORS_WIDTH);
}

/// How photons move through the cloud. Lengths are metres; `power` is in record units.
struct TraceParams {
    mat3 worldToCells;   // directions: cells per metre
    vec3 size;           // voxels
    ivec3 cells;         // of the majorant grid
    vec3 cellSize;       // voxels per cell
    float extinction;    // collision coefficient at density 1 [1/m]: σt(1 − f·min albedo)
    float scatterShare;  // probability that a collision is a scattering event
    vec3 albedo;
    vec3 straightWeight;    // weight of light that goes straight on at a collision
    float scatterFraction;  // 1 − f: what phase sampling is restricted to
    float asymmetry;        // g of the analytic sampler
    vec3 sunDirection;      // of travel
    float sunCone;          // 1 − cos of the disc's angular radius
    vec3 faceArea[3];       // area vectors of the box's faces across x, y, z [m²]
    vec3 faceSize;          // their lengths
    float sunThrough;       // area of the box that the middle of the sun's disc sees [m²]
    vec3 sunPower;
    vec3 skyPower;
    uint sunPhotons;  // the first ones of a generation
    uint photons;     // of a generation
    uint generation;
    uint stream;  // of the random numbers
    uint collectors;
    uint invocations;
    uint recordCapacity;  // of one invocation
    uint stepLimit;       // of one dispatch
    uint collisionLimit;  // of one photon
    uint estimatorBase;   // where the cells follow the collectors' coefficients
    int estimatorEdge;    // of a cell, voxels; 0: none
    ivec3 estimatorCells;
    uint axisBase;  // where the rings about the sun's axis follow the estimates
    AirPlace air;   // with an atmosphere only, as what follows
    mat3 skyAxes;   // from the map of the sky to the world
};

/// A photon between two dispatches.
struct TraceState {
    ivec3 cell;
    vec3 offset;  // in the cell, 0…1
    vec3 direction;
    vec3 weight;      // of the light's power
    float depth;      // optical depth left to the next tentative collision
    uint photon;      // number in the generation
    uint draws;       // random numbers drawn
    uint collisions;  // real ones
    uint scatterings;
    uint alive;
};

/// One photon that meets a collector.
struct PhotonRecord {
    uint collector;
    uint direction;  // octahedral, 16 bits each
    uvec2 power;     // three times 21 bits
};

/// What a generation has done so far.
struct TraceCounters {
    uint64_t events;
    uint64_t nulls;
    uint64_t absorbed;
    uint64_t escaped;
    uint64_t lost;
    uint64_t records;
    // of a laterally periodic layer only: escaped by where and how
    uint64_t reflected;
    uint64_t transmittedDiffuse;
    uint64_t transmittedDirect;
    uint pending;  // invocations that have not finished
    uint unused;
};

struct GatherPush {
    uint collectors;
    uint invocations;
    uint recordCapacity;
};

struct AccumulatePush {
    uint coefficients;
    int shift;       // of the generation's unit against the ring's
    uint keepSlots;  // whether the ring remembers its generations
};

struct ReconstructPush {
    uint collectors;
    float scale;  // ring units → W·m⁻², over the generations in the ring
    vec3 eye;     // voxel coordinates; a collector's direction to it is found in metres
    mat3 voxelToWorld;
    vec3 sunDirection;  // of travel
    uint axisBase;      // where the rings about the sun's axis begin
    float angleScale;   // of the axis of their table
};

#ifdef __cplusplus
// Scalar layout, as SPIR-V has it; tests/unit/shared_layout_test.cpp compares every member.
static_assert(sizeof(TraceParams) == 332 && offsetof(TraceParams, skyAxes) == 296);
static_assert(sizeof(TraceState) == 72 && offsetof(TraceState, alive) == 68);
static_assert(sizeof(PhotonRecord) == 16 && offsetof(PhotonRecord, power) == 8);
static_assert(sizeof(TraceCounters) == 80 && offsetof(TraceCounters, unused) == 76);
static_assert(sizeof(GatherPush) == 12 && offsetof(GatherPush, recordCapacity) == 8);
static_assert(sizeof(AccumulatePush) == 12 && offsetof(AccumulatePush, keepSlots) == 8);
static_assert(sizeof(ReconstructPush) == 76 && offsetof(ReconstructPush, angleScale) == 72);
#endif

SHARED_END

#endif
