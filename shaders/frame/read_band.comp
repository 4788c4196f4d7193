#version 460
#extension GL_GOOGLE_include_directive : require
// Layers of the frame become pixels in a buffer that the host reads.
#include "shared/frame.h"
#include "lib/pixel.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform sampler2D cloud;
layout(binding = 1) uniform sampler2D radiance;
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3) uniform sampler2D front;
layout(binding = 4, scalar) writeonly buffer Pixels { Pixel pixels[]; };
layout(push_constant, scalar) uniform Push { BandPush push; };

void main() {
    const ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, push.size))) return;
    const ivec2 at = push.first + place;
    const vec4 light = texelFetch(radiance, at, 0), front_ = texelFetch(cloud, at, 0);
    const int index = place.y * push.size.x + place.x;
    const Pixel pixel = Pixel(front_.rgb, light.a, front_.a, texelFetch(depth, at, 0).r, texelFetch(front, at, 0).r,
                              light.rgb, vec2(0.0));
    STORE_PIXEL(pixels, index, pixel);
}
