#version 460
#extension GL_GOOGLE_include_directive : require
// What a frame's background differs from a uniform sky by: light that the cloud takes out of it, and light that it has
// more (the sun's disc). The cloud is a layer as it is.
#include "shared/fog_layers.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform sampler2D cloud;  // alpha: how much of the pixel it covers
layout(binding = 1) uniform sampler2D radiance;
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3) uniform writeonly image2D shadow;
layout(binding = 4) uniform writeonly image2D bright;
layout(binding = 5, scalar) buffer Summary { LayerSummary summary; };
layout(push_constant, scalar) uniform Push { FogSplitPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.size))) return;
    const vec4 front = texelFetch(cloud, pixel, 0);
    // no rearrangement: what is left of nearly equal values decides whether a layer is filtered
    precise const vec3 behind = texelFetch(radiance, pixel, 0).rgb - front.rgb - push.sky;
    imageStore(shadow, pixel, vec4(max(-behind, 0.0), 0.0));
    imageStore(bright, pixel, vec4(max(behind, 0.0), 0.0));
    // the reads without order spare atomic writes that would change nothing
    if (summary.clouded == 0u && front.a > 0.0) atomicOr(summary.clouded, 1u);
    if (summary.lit == 0u && any(greaterThan(behind, vec3(0.0)))) atomicOr(summary.lit, 1u);
    const uint distance_ = floatBitsToUint(texelFetch(depth, pixel, 0).r);
    if (distance_ > summary.farthest) atomicMax(summary.farthest, distance_);
}
