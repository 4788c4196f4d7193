#version 460
#extension GL_GOOGLE_include_directive : require
// The sun's disc, seen through the cloud. Its few pixels come in a list: their shares of the disc are found in doubles.
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer SunPixels { SunPixel pixels[]; };
layout(binding = 1, rgba32f) uniform image2D radiance;  // alpha: transmittance of the cloud
layout(push_constant, scalar) uniform Push { SunPixelsPush push; };
#include "lib/linear.glsl"

void main() {
    const uint index = linearInvocation(64u);
    if (index >= uint(push.count)) return;
    const ivec2 pixel = pixels[index].pixel;
    const vec4 seen = imageLoad(radiance, pixel);
    imageStore(radiance, pixel, vec4(seen.rgb + pixels[index].radiance * seen.a, seen.a));
}
