#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// Mass-weighted radiance of the collectors in each cell of a grid: (Σ ρ L, Σ ρ) over the cell's voxels, the radiance
// scaled by the light that was counted in the cell against what its collectors have there on average. Collectors know
// where light goes, cells where it is.
#include "shared/draw.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform usampler3D collectorIndex;
layout(binding = 2, scalar) readonly buffer Radiance { vec4 collectorRadiance[]; };  // and fluence
layout(binding = 3) uniform writeonly image3D cells;
layout(binding = 4) uniform sampler3D cellMass;
layout(binding = 5, scalar) readonly buffer Deposits { int64_t deposits[]; };
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

/// Counts of all cells of the deposits in a cell.
float countedIn(ivec3 cell) {
    const ivec3 first = cell * push.depositsAcross;
    const ivec3 end = min(first + push.depositsAcross, push.depositCells);
    int64_t sum = 0l;
    for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x)
                sum += deposits[push.depositBase + uint((z * push.depositCells.y + y) * push.depositCells.x + x)];
    return float(sum);
}

void main() {
    const uint index = linearInvocation(64u);
    const uvec3 grid = uvec3(push.grid);
    if (index >= grid.x * grid.y * grid.z) return;
    const ivec3 cell = ivec3(index % grid.x, (index / grid.x) % grid.y, index / (grid.x * grid.y));
    const ivec3 lower = push.edge * cell;
    const ivec3 upper = min(lower + push.edge, push.size);
    vec4 sum = vec4(0.0);
    float fluence = 0.0;
    for (int z = lower.z; z < upper.z; ++z)
        for (int y = lower.y; y < upper.y; ++y)
            for (int x = lower.x; x < upper.x; ++x) {
                const float mass = texelFetch(density, ivec3(x, y, z), 0).r;
                if (mass > 0.0) {
                    const vec4 light = collectorRadiance[texelFetch(collectorIndex, ivec3(x, y, z), 0).r];
                    sum += mass * vec4(light.rgb, 1.0);
                    fluence += mass * light.a;
                }
            }
    if (sum.a > 0.0) {
        const float counted = countedIn(cell) * push.depositScale;
        const float expected = fluence / sum.a * texelFetch(cellMass, cell, 0).r * push.massScale;
        sum.rgb *= (counted + push.prior) / (expected + push.prior);
    }
    imageStore(cells, cell, sum);
}
