#version 460
layout(local_size_x = 8) in;

layout(binding = 0) uniform usampler2D picture;
layout(binding = 1, r32ui) writeonly uniform uimage2D doubled;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = textureSize(picture, 0);
    if (all(lessThan(at, size))) {
        // one texel to the right: the last column reads the border
        uint value = textureLod(picture, (vec2(at) + vec2(1.5, 0.5)) / vec2(size), 0.0).x;
        imageStore(doubled, at, uvec4(2u * value));
    }
}
