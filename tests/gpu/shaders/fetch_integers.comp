#version 460
layout(local_size_x = 8) in;

layout(binding = 0) uniform usampler2D picture;
layout(binding = 1, r32ui) writeonly uniform uimage2D doubled;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, textureSize(picture, 0)))) {
        uint value = texelFetch(picture, at, 0).x;
        imageStore(doubled, at, uvec4(2u * value));
    }
}
