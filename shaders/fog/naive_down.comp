#version 460
#extension GL_GOOGLE_include_directive : require
// Down the plain chain of blurred copies (Elek 2013, section 3.3, "naive").
#include "shared/fog.h"
#include "lib/pyramid.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const int PAIRS = 2;  // half the taps across
layout(binding = 0) uniform sampler2D finer;
layout(binding = 1) uniform writeonly image2D coarser;
layout(push_constant, scalar) uniform Push { LevelPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.coarserSize))) return;
    imageStore(coarser, push.coarserOffset + pixel, reduced(finer, push, pixel, PAIRS));
}
