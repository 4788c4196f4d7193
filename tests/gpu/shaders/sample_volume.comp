#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8) in;

layout(binding = 0) uniform sampler3D volume;
layout(scalar, binding = 1) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 2) writeonly buffer Values { float values[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) {
        values[i] = textureLod(volume, positions[i], 0.0).x;
    }
}
