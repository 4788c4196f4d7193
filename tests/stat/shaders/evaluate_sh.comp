#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/sh.h"

layout(constant_id = 0) const int BANDS = 4;
layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Directions { vec3 directions[]; };
layout(binding = 1, scalar) writeonly buffer Coefficients { float coefficients[]; };

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= directions.length()) return;
    float y[shMaxCoefficients];
    shEvaluate(BANDS, directions[index], y);
    for (int i = 0; i < BANDS * BANDS; ++i) {
        coefficients[index * BANDS * BANDS + i] = y[i];
    }
}
