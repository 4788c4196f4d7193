#version 460
#extension GL_GOOGLE_include_directive : require
// Copies a volume of integers to its place in an atlas.
#include "shared/instance.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform usampler3D source;
layout(binding = 1) uniform writeonly uimage3D atlas;
layout(push_constant, scalar) uniform Push { CopyVolumePush push; };

void main() {
    const uint number = linearInvocation(64u);
    const uvec3 size = uvec3(push.size);
    if (number >= size.x * size.y * size.z) return;
    const ivec3 texel = cellNumbered(number, push.size);
    imageStore(atlas, push.origin + texel, texelFetch(source, texel, 0));
}
