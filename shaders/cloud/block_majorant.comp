#version 460
#extension GL_GOOGLE_include_directive : require
// Largest texel that trilinear interpolation inside a block of voxels can see.
#include "shared/cloud.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 23) const int EDGE = BLOCK_EDGE;  // of a block, voxels
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, scalar) writeonly buffer Majorants { float majorants[]; };
layout(push_constant, scalar) uniform Push { BlockPush push; };

void main() {
    const uint block = linearInvocation(64u);
    const uvec3 blocks = uvec3(push.blocks);
    if (block >= blocks.x * blocks.y * blocks.z) return;
    const ivec3 lower = EDGE * ivec3(block % blocks.x, (block / blocks.x) % blocks.y, block / (blocks.x * blocks.y));
    const ivec3 first = max(lower - 1, ivec3(0));
    const ivec3 last = min(lower + EDGE, push.size - 1);
    float largest = 0.0;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) largest = max(largest, texelFetch(density, ivec3(x, y, z), 0).r);
    majorants[block] = largest;
}
