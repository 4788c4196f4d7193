// The sun's light that scattered once, per unit of σs and irradiance (single_scattering.h has the formula). The includer
// declares the buffer PhaseTable, the tables singleScatterH and singleScatterK as pictures (optical depth across, angle down,
// one medium below the other) and the constants FORWARD_CUT: whether the forward peak is cut, GREY: whether
// extinctionScale and tables are the same for all colours, and COLOURED: whether PhaseTable has three values an entry.
#ifndef LUMULUS_LIB_SUN_SOURCE
#define LUMULUS_LIB_SUN_SOURCE

#include "shared/draw.h"
#include "shared/phase_table.h"
#include "shared/phase.h"

/// exp of a multiple of extinctionScale; one exponential where the albedo is grey.
vec3 expScaled(vec3 x) { return GREY ? vec3(exp(x.x)) : exp(x); }

/// What of the sun's light depends on the view direction alone.
struct SunView {
    vec3 phase;       // p(θ)
    TableCell angle;  // in the single-scattering tables
    int firstRow;     // of the medium's tables
};

/// p between an entry of PhaseTable and the next.
vec3 phaseInCell(int first, float fraction) {
    if (!COLOURED) return vec3(exp(mix(phaseTable[first], phaseTable[first + 1], fraction)));
    const int red = 3 * first;
    return exp(mix(vec3(phaseTable[red], phaseTable[red + 1], phaseTable[red + 2]),
                   vec3(phaseTable[red + 3], phaseTable[red + 4], phaseTable[red + 5]), fraction));
}

SunView sunView(InstanceParams instance, vec3 viewDirection) {
    const ScatterAngle angle = angleBetween(params.light.sunTravel, -viewDirection);
    const float axis = angleToAxis(angle, instance.angleScale);
    const TableCell cell = tableCell(axis, phaseTableSize);
    const int first = MANY ? instance.phaseTable * phaseTableSize + cell.base : cell.base;
    return SunView(phaseInCell(first, cell.fraction),
                   tableCell(axis, singleScatterAngleCount),
                   MANY ? instance.phaseTable * (singleScatterAngleCount - 1) : 0);
}

/// Between the corners that a texel of a single-scattering table holds.
float betweenCorners(vec4 corners, vec2 place) {
    const vec2 atDepth = mix(corners.xz, corners.yw, place.x);
    return mix(atDepth.x, atDepth.y, place.y);
}

/// A look-up of `sun` at `depth`, a TableCell. An image cannot be handed to a function.
#define IN_CELL(table, depth, texel) \
    betweenCorners(imageLoad(table, ivec2(texel, sun.firstRow + sun.angle.base)), vec2(depth.fraction, sun.angle.fraction))
#define SINGLE_SCATTER_AT(table, depth)                                                                      \
    (GREY ? vec3(IN_CELL(table, depth, depth.base))                                                    \
          : vec3(IN_CELL(table, depth, 3 * depth.base), IN_CELL(table, depth, 3 * depth.base + 1),     \
                 IN_CELL(table, depth, 3 * depth.base + 2)))

/// H(τs,θ) and K(τ,θ) without their extinctionScale e^−κτ.
vec3 singleScatterBefore(SunView sun, InstanceParams instance, float tau) {
    const TableCell depth = tableCell(tauToAxis(tau, instance.tauMaximum), singleScatterTauCount);
    return SINGLE_SCATTER_AT(singleScatterH, depth);
}

vec3 singleScatterAfter(SunView sun, InstanceParams instance, float tau) {
    const TableCell depth = tableCell(tauToAxis(tau, instance.tauMaximum), singleScatterTauCount);
    return SINGLE_SCATTER_AT(singleScatterK, depth);
}

/// Radiance that a segment of optical thickness `thickness`, seen through `tauView` and lit through `tauSun`, sends to
/// the eye: the integral of the source over the segment with its attenuation.
vec3 sunScattered(SunView sun, InstanceParams instance, float tauSun, float tauView, float thickness) {
    // 1 − e^−x without cancellation for thin segments
    const float filled = thickness < 1.0e-3 ? thickness * (1.0 - 0.5 * thickness) : 1.0 - exp(-thickness);
    vec3 source = sun.phase * exp(-tauSun - tauView) * filled;
    if (FORWARD_CUT) {
        const vec3 scale = instance.extinctionScale;
        source += singleScatterBefore(sun, instance, tauSun) * expScaled(-scale * tauSun) * (exp(-tauView) * filled);
        const vec3 scaled = scale * thickness;
        const vec3 held = mix((1.0 - expScaled(-scaled)) / max(scale, 1.0e-6), vec3(thickness), lessThan(scaled, vec3(1.0e-3)));
        source += singleScatterAfter(sun, instance, tauSun + tauView + 0.5 * min(thickness, 1.0)) *
                  expScaled(-scale * (tauSun + tauView)) * held;
    }
    return instance.albedo * instance.sunIrradiance * source;
}

#endif
