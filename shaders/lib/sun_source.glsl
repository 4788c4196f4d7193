// The sun's light with one turn, per unit of σs and irradiance (one_turn.h has the formula). The includer declares the
// buffer PhaseTable, the tables oneTurnH and oneTurnK as pictures (optical depth across, angle down) and the constant
// ONE_TURN: whether the forward peak is cut, and GREY: whether decay and tables are the same for all colours.
#ifndef LUMULUS_LIB_SUN_SOURCE
#define LUMULUS_LIB_SUN_SOURCE

#include "shared/draw.h"
#include "shared/phase_table.h"

/// exp of a multiple of the decay; one exponential where the albedo is grey.
vec3 decayed(vec3 x) { return GREY ? vec3(exp(x.x)) : exp(x); }

/// What of the sun's light depends on the view direction alone.
struct SunView {
    float phase;  // p(θ)
    float angle;  // texture coordinate in the one-turn tables
};

/// Texture coordinate of an axis in [0,1] whose ends are the middles of the first and the last texel.
float texelMiddle(float axis, int size) { return (axis * float(size - 1) + 0.5) / float(size); }

SunView sunView(LightParams light, vec3 viewDirection) {
    const ScatterAngle angle = angleBetween(light.sunTravel, -viewDirection);
    const float axis = angleToAxis(angle, light.angleScale);
    const TableCell cell = tableCell(axis, phaseTableSize);
    return SunView(exp(mix(phaseTable[cell.base], phaseTable[cell.base + 1], cell.fraction)),
                   texelMiddle(axis, oneTurnAngleCount));
}

/// Where a depth lies in the one-turn tables.
vec2 oneTurnPlace(SunView sun, LightParams light, float tau) {
    return vec2(texelMiddle(tauToAxis(tau, light.tauMaximum), oneTurnTauCount), sun.angle);
}

/// H(τs,θ) and K(τ,θ) without their decay e^−κτ.
vec3 oneTurnBefore(SunView sun, LightParams light, float tau) {
    const vec4 held = textureLod(oneTurnH, oneTurnPlace(sun, light, tau), 0.0);
    return GREY ? held.rrr : held.rgb;
}

vec3 oneTurnAfter(SunView sun, LightParams light, float tau) {
    const vec4 held = textureLod(oneTurnK, oneTurnPlace(sun, light, tau), 0.0);
    return GREY ? held.rrr : held.rgb;
}

/// Radiance that a stretch of optical thickness `thickness`, seen through `tauView` and lit through `tauSun`, sends to
/// the eye: the integral of the source over the stretch with its attenuation.
vec3 sunScattered(SunView sun, LightParams light, float tauSun, float tauView, float thickness) {
    // 1 − e^−x without cancellation for thin stretches
    const float filled = thickness < 1.0e-3 ? thickness * (1.0 - 0.5 * thickness) : 1.0 - exp(-thickness);
    vec3 source = vec3(sun.phase * exp(-tauSun - tauView) * filled);
    if (ONE_TURN) {
        source += oneTurnBefore(sun, light, tauSun) * decayed(-light.decay * tauSun) * (exp(-tauView) * filled);
        const vec3 scaled = light.decay * thickness;
        const vec3 held = mix((1.0 - decayed(-scaled)) / max(light.decay, 1.0e-6), vec3(thickness), lessThan(scaled, vec3(1.0e-3)));
        source += oneTurnAfter(sun, light, tauSun + tauView + 0.5 * min(thickness, 1.0)) *
                  decayed(-light.decay * (tauSun + tauView)) * held;
    }
    return light.albedo * light.sunIrradiance * source;
}

/// Radiance of the sun's disc where the view meets it.
vec3 discSeen(LightParams light, vec3 direction) {
    return angleBetween(light.sunTravel, -direction).oneMinusCos <= light.sunCone ? light.sunDisc : vec3(0.0);
}

#endif
