#version 460
#extension GL_GOOGLE_include_directive : require
// Up the scattering pyramid: the light of a level with that of the coarser ones, spread. What was passed down is
// overwritten by what comes back; the finest level goes to `result`.
#include "shared/fog.h"
#include "lib/pyramid.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool CUBIC = true;  // interpolation of the coarser level
layout(binding = 0) uniform sampler2D kept;
layout(binding = 1) uniform sampler2D halfway;
layout(binding = 2) uniform sampler2D coarser;
layout(binding = 3) uniform writeonly image2D gathered;
layout(binding = 4) uniform writeonly image2D result;
layout(push_constant, scalar) uniform Push { LevelPush push; };

/// Light of the half step: the binomial filter {1, 2, 1}², in four taps.
vec3 spreadHalfway(vec2 place) {
    const PyramidLevel level = finerLevel(push);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        const vec2 corner = place + vec2((i & 1) - 0.5, (i >> 1) - 0.5);
        sum += levelAt(halfway, level, corner).rgb;
    }
    return 0.25 * sum;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.finerSize))) return;
    const vec2 place = vec2(pixel) + 0.5;
    const int level = push.level - 1;
    vec3 light = texelFetch(kept, push.finerOffset + pixel, 0).rgb + spreadHalfway(place);
    if (level < push.last) {
        const PyramidLevel from = coarserLevel(push);
        light += (CUBIC ? cubicAt(coarser, from, 0.5 * place) : levelAt(coarser, from, 0.5 * place)).rgb;
    }
    if (level == 0)
        imageStore(result, pixel, vec4(light, 1.0));
    else
        imageStore(gathered, push.finerOffset + pixel, vec4(light, 1.0));
}
