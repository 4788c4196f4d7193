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

shared vec4 sums[32];    // mass, moment
shared vec2 extremes[32];  // majorant, occupied voxels

void main() {
    const uint leaf = linearGroup();
    if (leaf >= push.leaves) return;
    const uint lane = gl_LocalInvocationID.x;
    const ivec3 lower = leaves[leaf].lower;
    const uvec3 extent = uvec3(leaves[leaf].upper - lower);
    const vec3 inverseSize = 1.0 / vec3(push.size);

    // The majorant looks one voxel beyond the leaf on every side.
    const uvec3 wide = extent + 2u;
    float majorant = 0.0;
    for (uint i = lane; i < wide.x * wide.y * wide.z; i += 32u) {
        const ivec3 voxel = lower - 1 + ivec3(i % wide.x, (i / wide.x) % wide.y, i / (wide.x * wide.y));
        majorant = max(majorant, densityOf(density, voxel, push.size));
    }
    extremes[lane].x = majorant;
    barrier();
    for (uint i = 0u; i < 32u; ++i) majorant = max(majorant, extremes[i].x);

    vec4 sum = vec4(0.0);
    float occupied = 0.0;
    const uint voxels = extent.x * extent.y * extent.z;
    if (majorant > 0.0) {
        for (uint i = lane; i < voxels; i += 32u) {
            const ivec3 local = ivec3(i % extent.x, (i / extent.x) % extent.y, i / (extent.x * extent.y));
            const vec4 mass = voxelMass(density, lower + local, inverseSize);
            sum += vec4(mass.x, mass.yzw + vec3(local) * mass.x);
            occupied += texelFetch(density, lower + local, 0).r > 0.0 ? 1.0 : 0.0;
        }
    }
    sums[lane] = sum;
    extremes[lane].y = occupied;
    barrier();
    if (lane == 0u) {
        for (uint i = 1u; i < 32u; ++i) {
            sum += sums[i];
            occupied += extremes[i].y;
        }
        statistics[leaf] = LeafStatistics(majorant, sum.x, sum.yzw, occupied / float(voxels));
    }
}
