#version 460
#extension GL_GOOGLE_include_directive : require
// Mean density that the rays meet in the middle of their chords through a sphere, over all directions: a chord at the
// distance b from the sphere's centre has the length 2√(R² − b²), and its middle lies at b.
#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, scalar) readonly buffer Spheres { vec4 spheres[]; };  // centre [voxels], radius [m]
layout(binding = 2, scalar) writeonly buffer Means { float means[]; };
layout(push_constant, scalar) uniform Push { BillboardMeanPush push; };

const int SAMPLES = 6;  // along each axis; even, so that none lies in the centre

void main() {
    const uint number = linearInvocation(64u);
    if (number >= push.spheres) return;
    const vec4 sphere = spheres[number];
    float met = 0.0, weights = 0.0;
    for (int i = 0; i < SAMPLES * SAMPLES * SAMPLES; ++i) {
        const vec3 place = vec3(i % SAMPLES, (i / SAMPLES) % SAMPLES, i / (SAMPLES * SAMPLES));
        const vec3 offset = 2.0 * (place + 0.5) / float(SAMPLES) - 1.0;
        const float squared = dot(offset, offset);
        const float weight = sqrt(max(1.0 - squared, 0.0) / squared);
        met += weight * densityAt(density, sphere.xyz + push.worldToVoxel * (sphere.w * offset), push.inverseSize);
        weights += weight;
    }
    means[number] = met / weights;
}
