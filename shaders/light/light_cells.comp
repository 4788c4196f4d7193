#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance of the collectors towards the eye in each cell with density, their mean by mass, scaled and corrected by what was
// counted in the cell (light_counts.comp). Fourth component: 1 where voxels have density.
#include "shared/draw.h"
#include "shared/photon.h"
#include "lib/collector.glsl"
#include "lib/density.glsl"
#include "lib/linear.glsl"
#include "lib/luminance.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int EDGE = 1;  // of a cell, voxels
layout(constant_id = 1) const bool COARSE = false;  // two voxels along each edge stand for all of a cell
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform usampler3D collectorIndex;
layout(binding = 2, rgba32f) uniform readonly image2D radiance;
layout(binding = 3, rgba32f) uniform readonly image3D counts;
layout(binding = 4) uniform writeonly image3D cells;  // with a ring of empty ones
layout(binding = 5, scalar) readonly buffer LitCells { uint litCells[]; };
layout(binding = 6, rgba32f) uniform readonly image2D colours;  // RGB fluence of the collectors
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

void main() {
    const int STRIDE = COARSE ? max(EDGE / 2, 1) : SPARSE ? max(EDGE / 4, 1) : 1;  // where there are many voxels, some stand for all of a cell
    const uint entry = linearInvocation(64u);
    if (entry >= push.occupied) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    vec4 light = vec4(0.0);
    vec3 colour = vec3(0.0);  // of all light in the cell, wherever it goes
    for (int z = STRIDE / 2; z < EDGE; z += STRIDE)
        for (int y = STRIDE / 2; y < EDGE; y += STRIDE)
            for (int x = STRIDE / 2; x < EDGE; x += STRIDE) {
                const ivec3 voxel = EDGE * cell + ivec3(x, y, z);
                const float mass = densityOf(density, voxel, push.size);
                if (mass > 0.0) {
                    const uint collector = push.firstCollector + collectorOf(collectorIndex, voxel, push.size);
                    light += mass * imageLoad(radiance, collectorTexel(collector));
                    colour += mass * imageLoad(colours, collectorTexel(collector)).rgb;
                }
            }
    // Cells count alike, however thin: weighted by mass, what is bright and thin would take the colour of what is behind.
    if (light.a > 0.0) light /= light.a;
    const float fluence = luminance(colour);
    if (fluence > 0.0) {
        const vec4 counted = imageLoad(counts, cell);
        const vec3 away = push.voxelToWorld * (push.eye - (vec3(cell) + 0.5) * float(EDGE));
        const float gain = dot(counted.xyz, away) * inversesqrt(max(dot(away, away), 1e-30));
        // The gain has the colour of all light there: the collectors' light towards the eye nearly cancels where few photons
        // met, and its colour is then that of one photon.
        light.rgb = counted.w * light.rgb + (gain / fluence) * colour;
    }
    imageStore(cells, cell + 1, light);
}
