#version 460
#extension GL_GOOGLE_include_directive : require
// Smooths the cells with (¼, ½, ¼) along each axis, those less where many photons were counted. What is looked up is
// divided by the fourth component, so that empty cells do not darken their neighbours.
#include "shared/draw.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D cells;
layout(binding = 1) uniform sampler3D ownShare;
layout(binding = 2) uniform writeonly image3D lightField;
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

void main() {
    const uint index = linearInvocation(64u);
    const uvec3 grid = uvec3(push.grid);
    if (index >= grid.x * grid.y * grid.z) return;
    const ivec3 cell = ivec3(index % grid.x, (index / grid.x) % grid.y, index / (grid.x * grid.y));
    const float own = texelFetch(ownShare, cell, 0).r;
    if (own < 0.0) {
        imageStore(lightField, cell, vec4(0.0));
        return;
    }
    // the mean of the eight linear look-ups half a cell away has exactly these weights
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 upper = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        sum += textureLod(cells, vec3(cell + upper) * push.scale, 0.0);
    }
    imageStore(lightField, cell, mix(0.125 * sum, texelFetch(cells, cell, 0), own));
}
