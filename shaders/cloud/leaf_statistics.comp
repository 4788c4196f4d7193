#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a leaf: majorant with the footprint of interpolation, mass, moment and occupied fraction.
#include "shared/cloud.h"
#include "lib/density.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 32) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, scalar) readonly buffer Leaves { LeafBox leaves[]; };
layout(binding = 2, scalar) writeonly buffer Statistics { LeafStatistics statistics[]; };
layout(push_constant, scalar) uniform Push { LeafPush push; };

shared vec4 sums[32];      // mass, moment
shared vec2 extremes[32];  // majorant, occupied voxels

/// What a voxel contributes along one axis to the integrals of the interpolated density over a leaf of this extent, and of
/// the density times the distance from the leaf's lower end: its own cell, and the ones before and behind it, which
/// interpolate it too. `at` counts from the leaf's lower end, -1 to extent. The sums are those of voxelMass() over all cells,
/// with one look-up a voxel instead of eight.
vec2 weightsAlong(int at, int extent) {
    vec2 weights = vec2(0.0);
    if (at >= 0 && at < extent) weights += vec2(0.75, 0.375 + 0.75 * float(at));
    if (at + 1 < extent) weights += vec2(0.125, 0.03125 + 0.125 * float(at + 1));
    if (at > 0) weights += vec2(0.125, 0.09375 + 0.125 * float(at - 1));
    return weights;
}

void main() {
    const uint leaf = linearGroup();
    if (leaf >= push.leaves) return;
    const uint lane = gl_LocalInvocationID.x;
    const ivec3 lower = leaves[leaf].lower, extent = leaves[leaf].upper - lower;

    // one voxel beyond the leaf on every side
    const uvec3 wide = uvec3(extent) + 2u;
    vec4 sum = vec4(0.0);
    float majorant = 0.0, occupied = 0.0;
    for (uint i = lane; i < wide.x * wide.y * wide.z; i += 32u) {
        const ivec3 local = ivec3(i % wide.x, (i / wide.x) % wide.y, i / (wide.x * wide.y)) - 1;
        const float value = densityOf(density, lower + local, push.size);
        if (value == 0.0) continue;
        majorant = max(majorant, value);
        if (all(greaterThanEqual(local, ivec3(0))) && all(lessThan(local, extent))) occupied += 1.0;
        const vec2 x = weightsAlong(local.x, extent.x), y = weightsAlong(local.y, extent.y),
                   z = weightsAlong(local.z, extent.z);
        sum += value * vec4(x.x * y.x * z.x, x.y * y.x * z.x, x.x * y.y * z.x, x.x * y.x * z.y);
    }
    sums[lane] = sum;
    extremes[lane] = vec2(majorant, occupied);
    barrier();
    if (lane == 0u) {
        for (uint i = 1u; i < 32u; ++i) {
            sum += sums[i];
            majorant = max(majorant, extremes[i].x);
            occupied += extremes[i].y;
        }
        const float voxels = float(extent.x) * float(extent.y) * float(extent.z);
        statistics[leaf] = LeafStatistics(majorant, sum.x, sum.yzw, occupied / voxels);
    }
}
