#version 460
#extension GL_GOOGLE_include_directive : require
// The layers of a picture without a cloud, under a sky of one radiance.
#include "shared/frame.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform writeonly image2D cloud;
layout(binding = 1) uniform writeonly image2D radiance;
layout(binding = 2) uniform writeonly image2D depth;
layout(binding = 3) uniform writeonly image2D front;
layout(push_constant, scalar) uniform Push { BackgroundPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.size))) return;
    const ivec2 within = pixel - push.withoutFirst;
    if (all(greaterThanEqual(within, ivec2(0))) && all(lessThan(within, push.withoutSize))) return;
    imageStore(cloud, pixel, vec4(0.0));
    imageStore(radiance, pixel, vec4(push.radiance, 1.0));
    imageStore(depth, pixel, vec4(FAR_DEPTH));
    imageStore(front, pixel, vec4(FAR_DEPTH));
}
