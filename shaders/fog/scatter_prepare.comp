#version 460
#extension GL_GOOGLE_include_directive : require
// Light of a picture in fog, split for the scattering pyramid's finest level.
#include "shared/fog.h"
#include "lib/fog_split.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const float STEP_VARIANCE = 2.1;
layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D distances;
layout(binding = 2, scalar) readonly buffer Media { FogMedium media[]; };
layout(binding = 3) uniform writeonly image2D kept;
layout(binding = 4) uniform writeonly image2D halfway;
layout(binding = 5) uniform writeonly image2D passed;
layout(push_constant, scalar) uniform Push { FogPush push; };
#include "lib/fog_light.glsl"

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.view.size))) return;
    const FogLight light = fogLight(pixel);
    const SplitLight split = splitLight(light.scattered, light.spread, 0, push.last, STEP_VARIANCE);
    imageStore(kept, pixel, vec4(light.sharp + split.kept, 1.0));
    imageStore(halfway, pixel, vec4(split.halfway, 1.0));
    imageStore(passed, pixel, split.passed);
}
