#version 460
#extension GL_GOOGLE_include_directive : require
// Smooths the cells with (¼, ½, ¼) along each axis, those less where many photons were counted. What is looked up is
// divided by the fourth component, so that empty cells do not darken their neighbours.
#include "shared/draw.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1, r32f) uniform readonly image3D ownShare;
layout(binding = 2) uniform writeonly image3D lightField;
layout(binding = 3, scalar) readonly buffer LitCells { uint litCells[]; };
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

void main() {
    const uint entry = linearInvocation(64u);
    if (entry >= push.lit) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    // the mean of the eight linear look-ups half a cell away has exactly these weights
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 upper = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        sum += textureLod(cells, vec3(cell + upper) * push.scale, 0.0);
    }
    sum *= 0.125;
    if (entry < push.occupied) sum = mix(sum, texelFetch(cells, cell, 0), imageLoad(ownShare, cell).r);
    imageStore(lightField, cell, sum);
}
