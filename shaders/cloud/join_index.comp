#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the index of a density in bricks to its place in the index of several.
#include "shared/cloud.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform usampler3D source;
layout(binding = 1) uniform writeonly uimage3D target;
layout(push_constant, scalar) uniform Push { CopyIndexPush push; };

ivec3 texelOf(uint number) { return ivec3(number & 1023u, (number >> 10) & 1023u, number >> 20); }

void main() {
    const uint number = linearInvocation(64u);
    if (number < push.count) imageStore(target, texelOf(push.first + number), texelFetch(source, texelOf(number), 0));
}
