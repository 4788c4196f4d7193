// A cloud of several as photons walk through it (shared/world.h). The includer declares `density`, the atlas or pool of all.
#ifndef LUMULUS_LIB_WALKED_INSTANCE
#define LUMULUS_LIB_WALKED_INSTANCE

#include "shared/world.h"
#include "lib/density.glsl"
#include "lib/traversal.glsl"

layout(binding = 21, rgba32f) uniform readonly imageBuffer walkedInstances;

vec4 texelOf(uint instance, int texel) { return imageLoad(walkedInstances, int(instance) * WALKED_TEXELS + texel); }

/// Where a walk is in the voxel coordinates of an instance.
vec3 voxelIn(uint instance, Walk walk) {
    const vec3 base = texelOf(instance, 5).xyz;
    const vec4 place = vec4(vec3(walk.cell - ivec3(base)) + walk.offset, 1.0);
    return vec3(dot(texelOf(instance, 0), place), dot(texelOf(instance, 1), place), dot(texelOf(instance, 2), place));
}

/// Collision coefficient of an instance at a voxel [1/m], a random number of that mean (lib/density.glsl).
float extinctionNear(uint instance, vec3 voxel, vec2 u) {
    const vec4 size = texelOf(instance, 3);
    if (any(lessThan(voxel, vec3(0.0))) || any(greaterThan(voxel, size.xyz))) return 0.0;
    const vec3 first = texelOf(instance, 4).xyz;
    if (SPARSE) return size.w * brickDensityNear(density, voxel, nearStep(u), ivec3(size.xyz), uint(first.x));
    return size.w * densityOf(density, voxelNear(voxel, u), ivec3(size.xyz), ivec3(first));
}

#endif
