#version 460
#extension GL_GOOGLE_include_directive : require
// The light field in each cell: the cells around it, weighted as light_plane.comp found.
#include "shared/draw.h"
#include "lib/light_cell.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly image3D cells;  // with two rings of empty ones
layout(binding = 1) uniform writeonly image3D lightField;
layout(binding = 2, scalar) readonly buffer LitCells { uint litCells[]; };
layout(binding = 3, rgba32f) uniform readonly imageBuffer planes;  // light_plane.comp
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

/// Part of the mean that a plane leaves everywhere.
const float LEAST = 0.2;

/// Σ weights · light of the cells around, and in the plane's place.
struct Around {
    vec3 light, inPlane;
};

Around around(ivec3 cell, vec4 plane, int reach) {
    Around sum = Around(vec3(0.0), vec3(0.0));
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const ivec3 by = ivec3(x, y, z);
                const vec4 there = imageLoad(cells, cell + CELL_RINGS + by);
                const vec3 at = vec3(by) + unpackedPlace(there.a) - 0.5;
                const vec3 light = cellWeight(by, reach) * there.rgb;  // 0 of empty cells
                sum.light += light;
                sum.inPlane += (dot(plane.xyz, at) + plane.w) * light;
            }
    return sum;
}

void main() {
    const uint entry = linearInvocation(64u);
    if (entry >= push.lit) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    const vec4 plane = imageLoad(planes, 2 * int(entry));
    const vec4 rest = imageLoad(planes, 2 * int(entry) + 1);
    if (rest.x <= 0.0) {
        imageStore(lightField, cell, vec4(0.0));
        return;
    }
    Around sum;
    if (rest.z < 1.5)
        sum = around(cell, plane, 1);
    else
        sum = around(cell, plane, 2);
    const vec3 here = sum.inPlane + rest.y * imageLoad(cells, cell + CELL_RINGS).rgb;
    imageStore(lightField, cell, vec4(max(here, LEAST * rest.x * sum.light), 1.0));
}
