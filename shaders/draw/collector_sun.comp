#version 460
#extension GL_GOOGLE_include_directive : require
// Effective optical depth to the sun of each collector: −ln of the mass-weighted mean transmittance over its leaf, so
// that the leaf's single scattering is right on the whole.
#include "shared/cloud.h"
#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform sampler3D sunDepth;
layout(binding = 2, scalar) readonly buffer Boxes { LeafBox boxes[]; };
layout(binding = 3, scalar) writeonly buffer SunDepths { float sunDepths[]; };
layout(push_constant, scalar) uniform Push { CollectorSunPush push; };

const int SAMPLES = 4;  // along each axis of the leaf

void main() {
    const uint collector = linearInvocation(64u);
    if (collector >= push.collectors) return;
    const vec3 lower = vec3(boxes[collector].lower);
    const vec3 extent = vec3(boxes[collector].upper) - lower;
    float mass = 0.0, transmitted = 0.0, least = 6.0e4;
    for (int i = 0; i < SAMPLES * SAMPLES * SAMPLES; ++i) {
        const vec3 place = vec3(i % SAMPLES, (i / SAMPLES) % SAMPLES, i / (SAMPLES * SAMPLES));
        const vec3 voxel = lower + extent * ((place + 0.5) / float(SAMPLES));
        const float weight = densityAt(density, voxel, push.inverseSize);
        const float depth = textureLod(sunDepth, push.voxelToTexture * voxel + push.textureOffset, 0.0).r;
        mass += weight;
        transmitted += weight * exp(-depth);
        least = min(least, depth);
    }
    // Where the mean underflows, the thinnest place says how dark it is.
    sunDepths[collector] = transmitted > 0.0 ? max(-log(transmitted / mass), 0.0) : least;
}
