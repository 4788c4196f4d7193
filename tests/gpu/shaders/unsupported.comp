#version 460
layout(local_size_x = 1) in;

layout(binding = 0) uniform Block { float value; } block;
layout(binding = 1) writeonly buffer Target { float values[]; } target;

void main() { target.values[0] = block.value; }
