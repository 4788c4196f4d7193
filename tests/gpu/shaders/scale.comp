#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const int factor = 2;
layout(constant_id = 2) const float half_step = 0.0;
layout(constant_id = 3) const bool negate = false;

layout(scalar, binding = 0) buffer Numbers { float numbers[]; };
layout(scalar, push_constant) uniform Push { ScalePush push; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.count) {
        float value = numbers[i] * float(factor) + half_step + float(push.bias);
        numbers[i] = negate ? -value : value;
    }
}
