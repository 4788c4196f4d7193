#version 460
layout(local_size_x = 8) in;

layout(binding = 0, r16f) uniform image3D volume;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(at, imageSize(volume)))) {
        imageStore(volume, at, imageLoad(volume, at) + vec4(float(at.x)));
    }
}
