#version 460
#extension GL_GOOGLE_include_directive : require
// In-scattered radiance of each collector towards the eye (Elek 2011, 5.8): the convolution of the incident light with
// the phase function is a factor for each band (Funk–Hecke).
#include "shared/phase_table.h"
#include "shared/photon.h"
#include "shared/sh.h"
#include "shared/sun_axis.h"
#include "lib/linear.glsl"
#include "lib/luminance.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int BANDS = 5;
layout(constant_id = 1) const bool AXIS = false;  // the sun's light is counted in rings about its axis too
layout(constant_id = 2) const bool MEDIA = false;  // collectors lie in different media

layout(binding = 0, scalar) readonly buffer Sum { int64_t sum[]; };
layout(binding = 1, scalar) readonly buffer Moments { float moments[]; };  // of each phase function, by band, then its scale of angles
layout(binding = 2, scalar) readonly buffer Collectors { vec4 collectors[]; };  // centre, mass [m²]
layout(binding = 3) uniform writeonly image2D fluences;  // of luminance, per unit of the leaf's ∫ σt' dV: flux, fluence
layout(binding = 4) uniform writeonly image2D radiance;
layout(binding = 5) uniform writeonly image2D colours;  // RGB fluence, per unit of the leaf's ∫ σt' dV
layout(binding = 6, scalar) readonly buffer AxisTable { float axisTable[]; };  // what a ring scatters, by ring and angle
layout(binding = 7, scalar) readonly buffer Media { uint media[]; };  // of each collector, where they differ
layout(push_constant, scalar) uniform Push { ReconstructPush push; };

/// Light of a ring, in counts.
vec3 ringLight(uint collector, int ring) {
    const uint place = push.axisBase + collector * AXIS_COUNTS + 3u * uint(ring);
    return vec3(sum[place], sum[place + 1u], sum[place + 2u]);
}

/// What the rings about one end of the axis scatter towards a direction at that angle to it, by the bands above.
vec3 scatteredByRings(uint collector, uint medium, int first, ScatterAngle angle) {
    const float scale = MEDIA ? moments[medium * uint(BANDS + 1) + uint(BANDS)] : push.angleScale;
    const TableCell cell = tableCell(angleToAxis(angle, scale), singleScatterAngleCount);
    const int table = int(medium) * AXIS_RINGS * singleScatterAngleCount;
    vec3 scattered = vec3(0.0);
    for (int ring = 0; ring < AXIS_RINGS; ++ring) {
        const int entry = table + ring * singleScatterAngleCount + cell.base;
        scattered += ringLight(collector, first + ring) * mix(axisTable[entry], axisTable[entry + 1], cell.fraction);
    }
    return scattered;
}

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
    const uint medium = MEDIA ? media[collector] : 0u;
    vec3 total = vec3(0.0);
    for (int l = 0; l < BANDS; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
            const vec3 coefficient = vec3(sum[base + uint(i)], sum[base + uint(COUNT + i)], sum[base + uint(2 * COUNT + i)]);
            total += (moments[medium * uint(BANDS + 1) + uint(l)] * y[i]) * coefficient;
        }
    if (AXIS) {
        total += scatteredByRings(collector, medium, 0, angleBetween(push.sunDirection, direction));
        total += scatteredByRings(collector, medium, AXIS_RINGS, angleBetween(-push.sunDirection, direction));
    }
    const vec3 mean = vec3(sum[base], sum[base + uint(COUNT)], sum[base + uint(2 * COUNT)]);
    const float unit = push.scale / place.w;
    vec3 flux = vec3(0.0);
    if (BANDS > 1) {
        // y_1m is a component of the direction times √3 y_00
        for (int axis = 0; axis < 3; ++axis) {
            const uint i = base + uint(axis == 0 ? 3 : axis);
            flux[axis] = luminance(vec3(sum[i], sum[i + uint(COUNT)], sum[i + uint(2 * COUNT)]));
        }
        flux *= 0.5773502692;
    }
    const ivec2 texel = collectorTexel(collector);
    imageStore(fluences, texel, vec4(unit / y[0] * flux, unit / y[0] * luminance(mean)));
    imageStore(radiance, texel, vec4(unit * total, 1.0));
    imageStore(colours, texel, vec4(unit / y[0] * mean, 1.0));
}
