#version 460
#extension GL_GOOGLE_include_directive : require
// The exact filter of the model: the light of a band of sources, each spread by a Gaussian of its own width.
#include "shared/fog.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform sampler2D scattered;
layout(binding = 1) uniform sampler2D sharp;
layout(binding = 2) uniform sampler2D across;  // shares of each source of the band in each column
layout(binding = 3) uniform sampler2D down;    // and in each row
layout(binding = 4, rgba32f) uniform image2D result;
layout(push_constant, scalar) uniform Push { ExactPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.size))) return;
    vec3 sum = push.firstRow == 0 ? texelFetch(sharp, pixel, 0).rgb : imageLoad(result, pixel).rgb;
    const int sources = push.rows * push.size.x;
    ivec2 source = ivec2(0, push.firstRow);
    for (int i = 0; i < sources; ++i) {
        const float share = texelFetch(down, ivec2(pixel.y, i), 0).r;
        if (share > 1.0e-12)
            sum += share * texelFetch(across, ivec2(pixel.x, i), 0).r * texelFetch(scattered, source, 0).rgb;
        source = source.x + 1 < push.size.x ? source + ivec2(1, 0) : ivec2(0, source.y + 1);
    }
    imageStore(result, pixel, vec4(sum, 1.0));
}
