#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to a picture of lit fog what of the clouds' light the filter has spread. What came straight is in it already.
#include "shared/fog.h"
#include "lib/taken_light.glsl"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform image2D cloud;
layout(binding = 1, rgba32f) uniform image2D radiance;
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3) uniform sampler2D before;  // the light that was filtered
layout(binding = 4) uniform sampler2D after;
layout(binding = 5, scalar) readonly buffer Media { FogMedium media[]; };
layout(push_constant, scalar) uniform Push { FogSpreadPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    vec3 origin, direction;
    viewRay(push.view, pixel, 1, origin, direction);
    const float distance_ = texelFetch(depth, pixel, 0).r;
    FogPath path = clearPath();
    for (int i = 0; i < push.media; ++i)
        addMedium(path, media[i], densityIntegral(media[i], origin, direction, distance_, push.skyDistance));
    const vec3 straight = attenuatedShare(path) * texelFetch(before, pixel, 0).rgb;
    const vec3 spread = push.sign_ * max(texelFetch(after, pixel + push.margin, 0).rgb - straight, 0.0);
    const vec4 front = imageLoad(cloud, pixel), seen = imageLoad(radiance, pixel);
    imageStore(cloud, pixel, vec4(leftOf(front.rgb, -spread), front.a));
    imageStore(radiance, pixel, vec4(leftOf(seen.rgb, -spread), seen.a));
}
