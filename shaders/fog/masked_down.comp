#version 460
#extension GL_GOOGLE_include_directive : require
// Down the chains of the masked filter: light masked by its spread, the spread weighed by luminance (Elek 2013, eq. 6 to
// 9), the depth, and separated light with its depth weighed by luminance (Iser 2017, eq. 4.26 and 4.27).
#include "shared/fog.h"
#include "lib/pyramid.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const int PAIRS = 2;  // half the taps across
layout(constant_id = 1) const bool SEPARATE = true;
layout(binding = 0) uniform sampler2D scatteredFiner;
layout(binding = 1) uniform sampler2D depthFiner;
layout(binding = 2) uniform sampler2D separatedFiner;
layout(binding = 3) uniform writeonly image2D scattered;
layout(binding = 4) uniform writeonly image2D depth;
layout(binding = 5) uniform writeonly image2D separated;
layout(push_constant, scalar) uniform Push { LevelPush push; };

/// ε of the mask: how softly it sets in (Iser 2017, section 4.5.4).
const float SOFTNESS = 2.0;
/// Weights of the filter, one pixel after the other; 2, 4 and 6 taps.
const float WEIGHTS[12] = float[12](0.5, 0.5, 0.13, 0.37, 0.37, 0.13, 0.03125, 0.15625, 0.3125, 0.3125, 0.15625, 0.03125);

struct Sums {
    vec3 light;     // masked
    vec2 spread;    // Σ Y W, Σ Y
    vec3 separated;
    vec2 nearness;  // Σ Y D, Σ Y of separated light
};

void addTap(inout Sums sums, ivec2 place, float weight) {
    const ivec2 once = max(place, -1 - place);
    const ivec2 inside = clamp(min(once, 2 * push.finerSize - 1 - once), ivec2(0), push.finerSize - 1);
    const ivec2 texel = push.finerOffset + inside;
    const vec4 light = texelFetch(scatteredFiner, texel, 0);
    const float threshold = push.levelScale * pow(2.0, float(push.level - 1));
    const float mask = smoothstep(threshold, (1.0 + SOFTNESS) * threshold, light.a);
    const float bright = luminance(light.rgb);
    sums.light += weight * mask * light.rgb;
    sums.spread += vec2(bright * light.a, bright);
    if (SEPARATE) {
        const vec4 apart = texelFetch(separatedFiner, texel, 0);
        sums.separated += weight * apart.rgb;
        sums.nearness += luminance(apart.rgb) * vec2(apart.a, 1.0);
    }
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.coarserSize))) return;
    Sums sums = Sums(vec3(0.0), vec2(0.0), vec3(0.0), vec2(0.0));
    const int first = PAIRS * (PAIRS - 1);
    for (int y = 0; y < 2 * PAIRS; ++y) {
        for (int x = 0; x < 2 * PAIRS; ++x)
            addTap(sums, 2 * pixel + ivec2(x, y) - (PAIRS - 1), WEIGHTS[first + x] * WEIGHTS[first + y]);
    }
    const ivec2 target = push.coarserOffset + pixel;
    imageStore(scattered, target, vec4(sums.light, sums.spread.y > 0.0 ? sums.spread.x / sums.spread.y : 0.0));
    imageStore(depth, target, reduced(depthFiner, push, pixel, PAIRS));
    if (SEPARATE) {
        const float near = sums.nearness.y > 0.0 ? sums.nearness.x / sums.nearness.y : 0.0;
        imageStore(separated, target, vec4(sums.separated, near));
    }
}
