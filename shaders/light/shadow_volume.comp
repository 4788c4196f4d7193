#version 460
#extension GL_GOOGLE_include_directive : require
// Optical depth from every point of a grid to the sun, within one instance. The grid's third axis runs along the light, so that one walk down
// a column fills it without the smearing of a sweep through the voxels.
#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/traversal.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform writeonly image3D shadowVolume;
layout(push_constant, scalar) uniform Push { ShadowVolumePush push; };

/// Half floats end at 65504; behind 6e4 no light is left.
const float DARK = 6.0e4;

float densityBelow(ivec2 column, float depth) {
    const vec3 voxel = push.originVoxel + push.gridToVoxel * vec3(column, depth);
    return densityAt(density, voxel, push.inverseSize);
}

void main() {
    const ivec2 column = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow);
    if (any(greaterThanEqual(column, push.grid.xy))) return;
    // the interpolated density reaches half a voxel beyond the volume
    const vec3 top = push.originVoxel + push.gridToVoxel * vec3(column, 0.0);
    const vec2 inside = clipToVolume(lineFrom(top + 0.5, push.gridToVoxel[2]), 1.0 / push.inverseSize + 1.0);
    float depth = 0.0;
    imageStore(shadowVolume, ivec3(column, 0), vec4(0.0));
    for (int k = 1; k < push.grid.z; ++k) {
        if (float(k) - 0.25 >= inside.x && float(k) - 0.75 <= inside.y) {
            const float above = densityBelow(column, float(k) - 0.75);
            const float below = densityBelow(column, float(k) - 0.25);
            depth += 0.5 * push.step * (above + below);
        }
        imageStore(shadowVolume, ivec3(column, k), vec4(min(depth, DARK)));
    }
}
