#version 460
#extension GL_GOOGLE_include_directive : require
// Drawn pixels become layers of the frame.
#include "shared/frame.h"
#include "lib/pixel.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) readonly uniform imageBuffer pixels;
layout(binding = 1) uniform writeonly image2D cloud;
layout(binding = 2) uniform writeonly image2D radiance;
layout(binding = 3) uniform writeonly image2D depth;
layout(binding = 4) uniform writeonly image2D front;
layout(push_constant, scalar) uniform Push { BandPush push; };

void main() {
    const ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, push.size))) return;
    const int index = place.y * push.size.x + place.x;
    const Pixel pixel = LOAD_PIXEL(pixels, index);
    imageStore(cloud, push.first + place, vec4(pixel.cloud, pixel.alpha));
    imageStore(radiance, push.first + place, vec4(pixel.radiance, pixel.transmittance));
    imageStore(depth, push.first + place, vec4(pixel.depth));
    imageStore(front, push.first + place, vec4(pixel.front));
}
