#version 460
layout(local_size_x = 8) in;

layout(binding = 0) readonly buffer Source { uint values[]; } source;
layout(binding = 1) writeonly buffer Target { uint values[]; } target;

void main() {
    uint i = gl_GlobalInvocationID.x;
    target.values[i] = source.values[i];
}
