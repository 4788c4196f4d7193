#version 460
#extension GL_GOOGLE_include_directive : require
// What leaf_statistics.comp finds, of a density in bricks: empty ones are passed over.
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

/// Adds the voxels of a brick within the leaf: mass, moment about `corner`, how many have density.
void addBrick(ivec3 lower, ivec3 upper, ivec3 corner, vec3 inverseSize, inout vec4 sum, inout float occupied) {
    const uvec3 extent = uvec3(upper - lower);
    for (uint i = gl_LocalInvocationID.x; i < extent.x * extent.y * extent.z; i += 32u) {
        const ivec3 voxel = lower + ivec3(i % extent.x, (i / extent.x) % extent.y, i / (extent.x * extent.y));
        const vec4 mass = voxelMass(density, voxel, inverseSize);
        sum += vec4(mass.x, mass.yzw + vec3(voxel - corner) * mass.x);
        occupied += densityOf(density, voxel, push.size) > 0.0 ? 1.0 : 0.0;
    }
}

/// The largest voxel in a brick's part of the leaf and one voxel beyond.
float largestIn(ivec3 lower, ivec3 upper) {
    const uvec3 extent = uvec3(upper - lower);
    float largest = 0.0;
    for (uint i = gl_LocalInvocationID.x; i < extent.x * extent.y * extent.z; i += 32u)
        largest = max(largest, densityOf(density, lower + ivec3(i % extent.x, (i / extent.x) % extent.y,
                                                                i / (extent.x * extent.y)), push.size));
    return largest;
}

void main() {
    const uint leaf = linearGroup();
    if (leaf >= push.leaves) return;
    const uint lane = gl_LocalInvocationID.x;
    const ivec3 lower = leaves[leaf].lower, upper = leaves[leaf].upper;
    const ivec3 wideLower = max(lower - 1, ivec3(0)), wideUpper = min(upper + 1, push.size);
    const vec3 inverseSize = 1.0 / vec3(push.size);
    const ivec3 first = wideLower / BRICK_EDGE, last = (wideUpper - 1) / BRICK_EDGE;
    vec4 sum = vec4(0.0);
    float occupied = 0.0, majorant = 0.0;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const ivec3 brick = ivec3(x, y, z), low = BRICK_EDGE * brick, high = low + BRICK_EDGE;
                if (isEmptyAround(brick, push.size)) continue;
                majorant = max(majorant, largestIn(max(low, wideLower), min(high, wideUpper)));
                if (all(lessThan(max(low, lower), min(high, upper))))
                    addBrick(max(low, lower), min(high, upper), lower, inverseSize, sum, occupied);
            }
    sums[lane] = sum;
    extremes[lane] = vec2(majorant, occupied);
    barrier();
    if (lane != 0u) return;
    for (uint i = 1u; i < 32u; ++i) {
        sum += sums[i];
        majorant = max(majorant, extremes[i].x);
        occupied += extremes[i].y;
    }
    const vec3 extent = vec3(upper - lower);
    statistics[leaf] = LeafStatistics(majorant, sum.x, sum.yzw, occupied / (extent.x * extent.y * extent.z));
}
