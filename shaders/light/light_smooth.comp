#version 460
#extension GL_GOOGLE_include_directive : require
// Smooths the cells with (¼, ½, ¼) along each axis, those less where many photons were counted. What is looked up is
// divided by the fourth component, so that empty cells do not darken their neighbours.
#include "shared/draw.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly image3D cells;  // with a ring of empty ones
layout(binding = 1, r32f) uniform readonly image3D ownShare;
layout(binding = 2) uniform writeonly image3D lightField;
layout(binding = 3, scalar) readonly buffer LitCells { uint litCells[]; };
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

void main() {
    const uint entry = linearInvocation(64u);
    if (entry >= push.lit) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    vec4 sum = vec4(0.0);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const float weight = float((2 - abs(x)) * (2 - abs(y)) * (2 - abs(z)));
                sum += weight * imageLoad(cells, cell + 1 + ivec3(x, y, z));
            }
    sum *= 1.0 / 64.0;
    if (entry < push.occupied) sum = mix(sum, imageLoad(cells, cell + 1), imageLoad(ownShare, cell).r);
    imageStore(lightField, cell, sum);
}
