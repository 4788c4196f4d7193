#version 460
#extension GL_GOOGLE_include_directive : require
// Smooths the cells with (¼, ½, ¼) along each axis. Mass and radiance stay apart until they are looked up, so that empty
// cells do not darken their neighbours.
#include "shared/draw.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Cells { vec4 cells[]; };
layout(binding = 1) uniform writeonly image3D lightField;
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

void main() {
    const uint index = linearInvocation(64u);
    const uvec3 grid = uvec3(push.grid);
    if (index >= grid.x * grid.y * grid.z) return;
    const ivec3 cell = ivec3(index % grid.x, (index / grid.x) % grid.y, index / (grid.x * grid.y));
    vec4 sum = vec4(0.0);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const ivec3 at = cell + ivec3(x, y, z);
                if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, push.grid))) continue;
                const ivec3 weights = 2 - abs(ivec3(x, y, z));
                sum += float(weights.x * weights.y * weights.z) * cells[(at.z * push.grid.y + at.y) * push.grid.x + at.x];
            }
    imageStore(lightField, cell, sum / 64.0);
}
