#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_control_flow_attributes : require
// Projects the photons of one collector, a chunk of them an invocation, on spherical harmonics (Elek 2011, 5.7, with the
// incident direction in place of the scattered one). Integers throughout: the sum does not depend on the order.
#include "shared/photon.h"
#include "lib/packing.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int BANDS = 5;
#include "shared/sh.h"
#include "lib/linear.glsl"

layout(binding = 0, scalar) readonly buffer ChunkOffsets { uint chunkOffsets[]; };
layout(binding = 1, scalar) readonly buffer Cursors { uint cursors[]; };  // now the end of each collector's records
layout(binding = 2, scalar) readonly buffer CollectorCounts { uint collectorCounts[]; };
layout(binding = 3, scalar) readonly buffer Sorted { uvec3 sorted[]; };
layout(binding = 4, scalar) buffer Coefficients { int64_t coefficients[]; };  // [collector][RGB][BANDS²]
layout(push_constant, scalar) uniform Push { GatherPush push; };

/// The collector whose chunks contain this one.
uint findCollector(uint chunk) {
    uint low = 0u, high = push.collectors - 1u;
    for (int halving = 0; halving < 32; ++halving) {
        const uint middle = (low + high) / 2u;
        const bool below = chunkOffsets[middle + 1u] > chunk;
        low = below ? low : min(middle + 1u, high);
        high = below ? middle : high;
    }
    return low;
}

void main() {
    const uint chunk = linearInvocation(64u);
    if (chunk >= chunkOffsets[push.collectors]) return;
    const uint collector = findCollector(chunk);
    const uint end = cursors[collector];
    const uint first = end - collectorCounts[collector] + (chunk - chunkOffsets[collector]) * GATHER_CHUNK;
    const uint last = min(first + GATHER_CHUNK, end);

    const int COUNT = BANDS * BANDS;
    // Unrolled by hand: Mesa 22.3 unrolls up to 32 rounds, and 6 bands have 36; sums in memory cost six times as much.
    ivec3 sums[BANDS * BANDS];
    [[unroll]] for (int i = 0; i < COUNT; ++i) sums[i] = ivec3(0);
    for (uint record = first; record < last; ++record) {
        const uvec3 photon = sorted[record];
        const vec3 power = COEFFICIENT_SCALE * unpackPower(photon.yz);
        float y[shMaxCoefficients];
        shEvaluate(BANDS, unpackDirection(photon.x), y);
        [[unroll]] for (int i = 0; i < COUNT; ++i) sums[i] += ivec3(roundEven(power * y[i]));
    }
    const uint base = collector * uint(3 * COUNT);
    [[unroll]] for (int channel = 0; channel < 3; ++channel)
        [[unroll]] for (int i = 0; i < COUNT; ++i)
            atomicAdd(coefficients[base + uint(channel * COUNT + i)], int64_t(sums[i][channel]));
}
