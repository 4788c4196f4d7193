#version 460
#extension GL_GOOGLE_include_directive : require
// Point samples distributed as |∇ρ| (Elek 2011, 5.2): a block by the prefix sum of the gradient bounds, a point in it,
// and a rejection against the block's own bound. Rejecting against the supremum of the whole field would stall on a spike.
#include "shared/cloud.h"
#include "shared/rng.h"
#include "lib/gradient.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, scalar) readonly buffer Bounds { float bounds[]; };
layout(binding = 2, scalar) readonly buffer Cumulative { uint cumulative[]; };  // up to and with each block, of 2³²
layout(binding = 3, scalar) writeonly buffer Samples { vec4 samples[]; };       // voxel coordinates, density
layout(binding = 4, scalar) readonly buffer Places { ivec3 places[]; };         // of the blocks, where these are bricks
layout(push_constant, scalar) uniform Push { SamplePush push; };

/// First block whose cumulative share exceeds u.
uint findBlock(uint u, uint count) {
    uint low = 0u, high = count - 1u;
    for (int halving = 0; halving < 32; ++halving) {
        const uint middle = (low + high) / 2u;
        const bool below = cumulative[middle] > u;
        low = below ? low : min(middle + 1u, high);
        high = below ? middle : high;
    }
    return low;
}

/// Of a block, in blocks.
ivec3 placeOf(uint block) {
    if (SPARSE) return places[block];
    const uvec3 blocks = uvec3(push.blocks);
    return ivec3(block % blocks.x, (block / blocks.x) % blocks.y, block / (blocks.x * blocks.y));
}

void main() {
    const uint index = linearInvocation(64u);
    if (index >= push.samples) return;
    const uvec3 blocks = uvec3(push.blocks);
    const vec3 inverseSize = 1.0 / vec3(push.size);
    vec3 point = vec3(0.0);
    bool accepted = false;
    // A bound on the trials keeps a degenerate field from hanging the device; the last trial is kept.
    for (uint trial = 0u; trial < 4096u && !accepted; ++trial) {
        const uvec4 bits = pcg4d(uvec4(index, trial, 0x5A3Du, push.seed));
        const vec4 u = rngUniform4(uvec4(index, trial, 0x5A3Eu, push.seed));
        const uint block = findBlock(bits.x, blocks.x * blocks.y * blocks.z);
        point = float(SPARSE ? BRICK_EDGE : BLOCK_EDGE) * (vec3(placeOf(block)) + u.xyz);
        const bool inside = all(lessThan(point, vec3(push.size)));
        accepted = inside && u.w * bounds[block] < gradientAt(density, point, inverseSize, push.gradientToMetres);
    }
    samples[index] = vec4(min(point, vec3(push.size)), densityAt(density, point, inverseSize));
}
