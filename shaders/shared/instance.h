// An instance of a cloud as drawing passes see it: where it lies, what it is made of, where its volumes are found.
#ifndef LUMULUS_SHARED_INSTANCE_H
#define LUMULUS_SHARED_INSTANCE_H

#include "shared/air_light.h"
#include "shared/prelude.h"

SHARED_BEGIN

/// `voxel` are voxel coordinates of the instance; positions in metres are relative to the eye.
struct InstanceParams {
    mat3 worldToVoxel;   // of directions: voxels per metre
    vec3 eyeVoxel;       // the camera's position
    vec3 size;           // of the density volume, voxels
    ivec3 cells;         // of the majorant grid
    vec3 cellSize;       // voxels
    float extinction;    // σt at density 1 [1/m]
    float voxelLength;   // metres: the finest step of a march; 0 where voxels are no cubes
    vec3 radianceScale;  // voxel → texture coordinates of the in-scattered radiance
    mat3 voxelToShadow;  // voxel → texture coordinates of the shadow volume
    vec3 shadowOffset;
    vec3 sunIrradiance;  // that reaches the instance
    vec3 albedo;
    vec3 extinctionScale;  // κ = 1 − ω f: optical depth of the truncated medium per true optical depth
    float scatterShare;    // 1 − f
    float angleScale;      // axes of the phase tables
    float tauMaximum;
    int phaseTable;  // number of its table
    // Where several instances share atlases: first texels of its volumes there, and how far they reach.
    vec3 densityOrigin, lightOrigin, shadowOrigin;
    ivec3 cellOrigin;
    vec3 lightSize, shadowSize;
    int firstBrick;  // of its bricks in the index of all, where the density is in bricks
    // With an atmosphere: the sun's light within the instance, and where its table begins.
    AirPlace air;
    vec2 airTexel;
};

/// Of an instance, texels for rays that look for it: three rows of metres to voxels, then its size and a voxel's
/// length.
const int INSTANCE_TEXELS = 4;

/// Reciprocals of the atlases' sizes [1/texels]; unused where there is one instance.
struct AtlasParams {
    vec3 density, light, shadow;
};

/// A copy of a volume into an atlas.
struct CopyVolumePush {
    ivec3 size;
    ivec3 origin;
};

/// A cloud that may stand between another cloud and the sun: how its shadow volume is found from a texel of the
/// other's. Five texels.
struct Occluder {
    vec4 texelToTexel[3];  // rows: texel number of the shaded volume to texel coordinates of this one's
    vec4 origin;           // of its volume in the atlas
    vec4 size;             // texels
};
const int OCCLUDER_TEXELS = 5;
/// Texels of a column that are filled together.
const int SHADOW_SEGMENT = 8;

/// The shadow volume of one instance, with what stands before it.
struct SharedShadowPush {
    ivec3 size;    // texels
    ivec3 origin;  // in the atlas
    uint first;    // of its occluders
    uint occluders;
};

#ifdef __cplusplus
static_assert(sizeof(Occluder) == 16 * OCCLUDER_TEXELS && offsetof(Occluder, size) == 64);
static_assert(sizeof(SharedShadowPush) == 32 && offsetof(SharedShadowPush, occluders) == 28);
static_assert(sizeof(InstanceParams) == 320 && offsetof(InstanceParams, airTexel) == 312);
static_assert(sizeof(AtlasParams) == 36 && offsetof(AtlasParams, shadow) == 24);
static_assert(sizeof(CopyVolumePush) == 24 && offsetof(CopyVolumePush, origin) == 12);
#endif

SHARED_END

#endif
