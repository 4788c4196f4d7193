#version 460
#extension GL_GOOGLE_include_directive : require
// The sun's disc beside the cloud. Its few pixels come in a list: their shares of the disc are found in doubles.
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer SunPixels { SunPixel pixels[]; };
layout(binding = 1) uniform writeonly image2D radiance;
layout(push_constant, scalar) uniform Push { SunPixelsPush push; };
#include "lib/linear.glsl"

void main() {
    const uint index = linearInvocation(64u);
    if (index < uint(push.count)) imageStore(radiance, pixels[index].pixel, vec4(pixels[index].radiance, 1.0));
}
