#version 460
#extension GL_GOOGLE_include_directive : require
// Light that photons have brought to the ground, from counts to watts.
#include "shared/ground.h"

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Sum { int64_t sum[]; };
layout(binding = 1, scalar) writeonly buffer Watts { float watts[]; };
layout(push_constant, scalar) uniform Push { GroundCountsPush push; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < push.count) watts[i] = push.unit * float(sum[push.base + i]);
}
