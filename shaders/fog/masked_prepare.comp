#version 460
#extension GL_GOOGLE_include_directive : require
// The finest levels of the other two chains of the masked filter: the variance of the spread, which stands for the
// rescaled distance (proportional to it without absorption), and bright light of small spread, which is filtered apart
// (Iser 2017, eq. 4.24 and 4.25).
#include "shared/fog.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform image2D scattered;
layout(binding = 1) uniform writeonly image2D depth;
layout(binding = 2) uniform writeonly image2D separated;
layout(push_constant, scalar) uniform Push { SeparationPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.size))) return;
    const vec4 light = imageLoad(scattered, pixel);
    const float bright = smoothstep(push.luminance, 2.0 * push.luminance, luminance(light.rgb));
    const float near = 1.0 - smoothstep(0.5 * push.spread, push.spread, light.a);
    const float mask = push.strength * bright * near;
    const float variance = light.a * light.a;
    imageStore(depth, pixel, vec4(variance));
    imageStore(separated, pixel, vec4(mask * light.rgb, variance));
    imageStore(scattered, pixel, vec4((1.0 - mask) * light.rgb, light.a));
}
