#version 460
#extension GL_GOOGLE_include_directive : require
// Mass of each cell of the light field, as photons meet it: the integral of the interpolated density [voxels].
#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform writeonly image3D cellMass;
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

void main() {
    const uint index = linearInvocation(64u);
    if (index >= uint(push.grid.x) * uint(push.grid.y) * uint(push.grid.z)) return;
    const ivec3 cell = cellNumbered(index, push.grid);
    const ivec3 lower = push.edge * cell;
    const ivec3 upper = min(lower + push.edge, push.size);
    const vec3 inverseSize = 1.0 / vec3(push.size);
    float sum = 0.0;
    for (int z = lower.z; z < upper.z; ++z)
        for (int y = lower.y; y < upper.y; ++y)
            for (int x = lower.x; x < upper.x; ++x) sum += voxelMass(density, ivec3(x, y, z), inverseSize).x;
    imageStore(cellMass, cell, vec4(sum));
}
