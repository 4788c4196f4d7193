#version 460
#extension GL_GOOGLE_include_directive : require
// Light with a margin around it, so that a filter spreads it out of the picture instead of mirroring it at the border. Beyond
// the border it goes on as it is there and fades.
#include "shared/fog.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform sampler2D light;
layout(binding = 1) uniform sampler2D depth;
layout(binding = 2, rgba32f) uniform writeonly image2D wideLight;
layout(binding = 3, r32f) uniform writeonly image2D wideDepth;
layout(push_constant, scalar) uniform Push { FogMarginPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(wideLight)))) return;
    const ivec2 inside = clamp(pixel - push.margin, ivec2(0), textureSize(light, 0) - 1);
    const vec2 beyond = abs(vec2(pixel - push.margin - inside)) / vec2(max(push.margin, ivec2(1)));
    const float share = max(1.0 - beyond.x, 0.0) * max(1.0 - beyond.y, 0.0);
    imageStore(wideLight, pixel, share * texelFetch(light, inside, 0));
    imageStore(wideDepth, pixel, vec4(texelFetch(depth, inside, 0).r));
}
