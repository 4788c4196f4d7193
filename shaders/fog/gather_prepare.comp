#version 460
#extension GL_GOOGLE_include_directive : require
// Light of a picture in fog for the filters that gather: what stays in its pixel, and what is scattered with its spread.
#include "shared/fog.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D distances;
layout(binding = 2, scalar) readonly buffer Media { FogMedium media[]; };
layout(binding = 3) uniform writeonly image2D sharp;
layout(binding = 4) uniform writeonly image2D scattered;
layout(push_constant, scalar) uniform Push { FogPush push; };
#include "lib/fog_light.glsl"

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.view.size))) return;
    const FogLight light = fogLight(pixel);
    imageStore(sharp, pixel, vec4(light.sharp, 1.0));
    imageStore(scattered, pixel, vec4(light.scattered, light.spread));
}
