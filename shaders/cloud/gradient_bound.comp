#version 460
#extension GL_GOOGLE_include_directive : require
// Upper bound of |∇ρ| in each block: the largest gradient at the voxels whose interpolation reaches into it.
#include "shared/cloud.h"
#include "lib/gradient.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, scalar) readonly buffer Majorants { float majorants[]; };
layout(binding = 2, scalar) writeonly buffer Bounds { float bounds[]; };
layout(push_constant, scalar) uniform Push { BlockPush push; };

/// Whether every block around is empty, so that no gradient reaches into this one.
bool emptyAround(ivec3 block) {
    for (int z = max(block.z - 1, 0); z <= min(block.z + 1, push.blocks.z - 1); ++z)
        for (int y = max(block.y - 1, 0); y <= min(block.y + 1, push.blocks.y - 1); ++y)
            for (int x = max(block.x - 1, 0); x <= min(block.x + 1, push.blocks.x - 1); ++x)
                if (majorants[(z * push.blocks.y + y) * push.blocks.x + x] > 0.0) return false;
    return true;
}

void main() {
    const uint index = linearInvocation(64u);
    const uvec3 blocks = uvec3(push.blocks);
    if (index >= blocks.x * blocks.y * blocks.z) return;
    const ivec3 block = ivec3(index % blocks.x, (index / blocks.x) % blocks.y, index / (blocks.x * blocks.y));
    float bound = 0.0;
    if (!emptyAround(block)) {
        const ivec3 lower = BLOCK_EDGE * block;
        for (int z = -1; z <= BLOCK_EDGE; ++z)
            for (int y = -1; y <= BLOCK_EDGE; ++y)
                for (int x = -1; x <= BLOCK_EDGE; ++x)
                    bound = max(bound, gradientOf(density, lower + ivec3(x, y, z), push.size, push.gradientToMetres));
    }
    bounds[index] = bound;
}
