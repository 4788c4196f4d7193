#version 460
layout(local_size_x = 8, local_size_y = 8) in;

// The next mip level of an array of pictures: a linear sample at the common corner of four texels is their mean.
layout(binding = 0) uniform sampler2DArray finer;
layout(binding = 1, r32f) writeonly uniform image2DArray coarser;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    ivec3 size = imageSize(coarser);
    if (all(lessThan(at, size))) {
        vec2 corner = (vec2(at.xy) + 0.5) / vec2(size.xy);
        imageStore(coarser, at, textureLod(finer, vec3(corner, float(at.z)), 0.0));
    }
}
