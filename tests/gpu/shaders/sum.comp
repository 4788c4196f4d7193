#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
layout(local_size_x = 64) in;

layout(binding = 0) buffer Sum { uint64_t total; } sum;

void main() {
    atomicAdd(sum.total, 0x100000000ul + uint64_t(gl_GlobalInvocationID.x));
}
