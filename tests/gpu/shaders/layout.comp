#version 460
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = 1) in;

layout(scalar, binding = 0) buffer Records { uint count; Outer records[]; };

void main() {
    records[gl_GlobalInvocationID.x].last = count + records[gl_GlobalInvocationID.x].inner[1].direction.length();
}
