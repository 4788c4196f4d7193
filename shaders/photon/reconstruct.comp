#version 460
#extension GL_GOOGLE_include_directive : require
// In-scattered radiance of each collector towards the eye (Elek 2011, 5.8): the convolution of the incident light with
// the phase function is a factor for each band (Funk–Hecke).
#include "shared/photon.h"
#include "shared/sh.h"
#include "lib/linear.glsl"
#include "lib/luminance.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int BANDS = 5;

layout(binding = 0, scalar) readonly buffer Sum { int64_t sum[]; };
layout(binding = 1, scalar) readonly buffer Moments { float moments[]; };      // of the phase function, by band
layout(binding = 2, scalar) readonly buffer Collectors { vec4 collectors[]; };  // centre, mass [m²]
layout(binding = 3, scalar) writeonly buffer Radiance { vec4 radiance[]; };  // and fluence (luminance)
layout(push_constant, scalar) uniform Push { ReconstructPush push; };

void main() {
    const uint collector = linearInvocation(64u);
    if (collector >= push.collectors) return;
    const vec4 place = collectors[collector];
    const vec3 away = push.voxelToWorld * (push.eye - place.xyz);
    // A collector at the eye itself sends nothing into it; any direction will do.
    const vec3 direction = dot(away, away) > 0.0 ? normalize(away) : vec3(0.0, 1.0, 0.0);
    float y[shMaxCoefficients];
    shEvaluate(BANDS, direction, y);
    const int COUNT = BANDS * BANDS;
    const uint base = collector * uint(3 * COUNT);
    vec3 total = vec3(0.0);
    for (int l = 0; l < BANDS; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
            const vec3 coefficient = vec3(sum[base + uint(i)], sum[base + uint(COUNT + i)], sum[base + uint(2 * COUNT + i)]);
            total += (moments[l] * y[i]) * coefficient;
        }
    const vec3 mean = vec3(sum[base], sum[base + uint(COUNT)], sum[base + uint(2 * COUNT)]);
    radiance[collector] = vec4(total, luminance(mean) / y[0]) * (push.scale / place.w);
}
