// Phase functions and how to sample them. Densities are per steradian, ∫ p dω = 1; θ is between the directions of
// travel before and after, c = cos θ. Sharp lobes live where c rounds to ±1, so angles are carried as 1−c and 1+c.
#ifndef LUMULUS_SHARED_PHASE_H
#define LUMULUS_SHARED_PHASE_H

#include "shared/prelude.h"

SHARED_BEGIN

/// A scattering angle θ that keeps its digits at both ends.
struct ScatterAngle {
    float oneMinusCos;  ///< 1 − cos θ, in [0,2]
    float onePlusCos;   ///< 1 + cos θ, in [0,2]
    float sinTheta;     ///< in [0,1]
};

/// The angle whose 1 − cos θ is given; digits of 1 + cos θ are those left by the subtraction.
SHARED_FN ScatterAngle angleFromOneMinusCos(float oneMinusCos) {
    float onePlusCos = max(2.0F - oneMinusCos, 0.0F);
    return ScatterAngle(oneMinusCos, onePlusCos, sqrt(oneMinusCos * onePlusCos));
}

/// The angle between two unit vectors, precise for nearly parallel and nearly opposite ones.
SHARED_FN ScatterAngle angleBetween(vec3 from, vec3 to) {
    vec3 difference = to - from;
    vec3 sum = to + from;
    float oneMinusCos = 0.5F * dot(difference, difference);
    float onePlusCos = 0.5F * dot(sum, sum);
    return ScatterAngle(oneMinusCos, onePlusCos, sqrt(oneMinusCos * onePlusCos));
}

/// Henyey–Greenstein, −1 < g < 1, by (1−g)² + 2g(1−c) instead of 1 + g² − 2gc, which cancels at g = .9999.
SHARED_FN float henyeyGreenstein(float g, ScatterAngle angle) {
    const float inverseFourPi = 0.0795774715F;
    float a = abs(g);
    float towards = g < 0.0F ? angle.onePlusCos : angle.oneMinusCos;
    float b = (1.0F - a) * (1.0F - a) + 2.0F * a * towards;
    return inverseFourPi * (1.0F - a) * (1.0F + a) / (b * sqrt(b));
}

/// The same from the cosine; good for |g| up to about .95.
SHARED_FN float henyeyGreensteinCos(float g, float cosTheta) {
    return henyeyGreenstein(g, ScatterAngle(1.0F - cosTheta, 1.0F + cosTheta, 0.0F));
}

/// Schlick's k that stands for an asymmetry g: |k| < 1, so a phase function, for |g| < .938 only.
SHARED_FN float schlickK(float g) {
    return g * (1.55F - 0.55F * g * g);
}

/// Blasi, Le Saëc and Schlick 1993; cos θ of travel, so forward lobes for k > 0.
SHARED_FN float schlick(float k, ScatterAngle angle) {
    const float inverseFourPi = 0.0795774715F;
    float a = abs(k);
    float b = (1.0F - a) + a * (k < 0.0F ? angle.onePlusCos : angle.oneMinusCos);
    return inverseFourPi * (1.0F - a) * (1.0F + a) / (b * b);
}

SHARED_FN float rayleigh(float cosTheta) {
    return 0.0596831037F * (1.0F + cosTheta * cosTheta);
}

/// Lorenz–Mie, hazy atmosphere (Nishita 1987).
SHARED_FN float hazy(ScatterAngle angle) {
    float x = 0.5F * angle.onePlusCos;
    float x2 = x * x;
    float x4 = x2 * x2;
    return 0.0795774715F * (0.5F + 4.5F * x4 * x4);
}

/// Lorenz–Mie, murky atmosphere (Nishita 1987).
SHARED_FN float murky(ScatterAngle angle) {
    float x = 0.5F * angle.onePlusCos;
    float x2 = x * x;
    float x4 = x2 * x2;
    float x8 = x4 * x4;
    float x16 = x8 * x8;
    return 0.0795774715F * (0.5F + 16.5F * x16 * x16);
}

/// Draine 2003: Henyey–Greenstein times (1 + α c²), normalised.
SHARED_FN float draine(float g, float alpha, ScatterAngle angle) {
    float c = 1.0F - angle.oneMinusCos;
    return henyeyGreenstein(g, angle) * (1.0F + alpha * c * c) / (1.0F + alpha * (1.0F + 2.0F * g * g) / 3.0F);
}

/// Fog and cloud droplets (Jendersie and d'Eon 2023); `fit` = (g of HG, g of Draine, α of Draine, weight of Draine).
SHARED_FN float droplet(vec4 fit, ScatterAngle angle) {
    return mix(henyeyGreenstein(fit.x, angle), draine(fit.y, fit.z, angle), fit.w);
}

/// An angle distributed as Henyey–Greenstein, −1 < g < 1, u uniform in [0,1), from the stable inversion: no branch near
/// g = 0 and |cos θ| never above 1. Restricted to θ ≥ θc where `scatterFraction` = P(θ ≥ θc) (1: not restricted).
SHARED_FN ScatterAngle sampleHg(float g, float u, float scatterFraction) {
    // u runs from backward to forward for g ≥ 0; a backward lobe is the mirror image, and there the cut takes low u
    // away
    bool backward = g < 0.0F;
    float a = abs(g);
    float w = backward ? scatterFraction * (1.0F - u) : 1.0F - scatterFraction * u;
    u = backward ? 1.0F - w : scatterFraction * u;
    float d = (1.0F - a) + 2.0F * a * u;
    float minus = (1.0F - a) / d;
    float plus = (1.0F + a) / d;
    // the clamps catch the last bit
    float along = min(2.0F * w * minus * minus * (1.0F + a * u), 2.0F);
    float against = min(2.0F * u * plus * plus * ((1.0F - a) + a * u), 2.0F);
    float sinTheta = min(sqrt(along * against), 1.0F);
    return backward ? ScatterAngle(against, along, sinTheta) : ScatterAngle(along, against, sinTheta);
}

/// The unit vector at `angle` from the unit vector `d`, azimuth phi [radians] about it. The basis is that of Duff et
/// al. 2017; one Newton step keeps the length at 1 over any number of scattering events.
SHARED_FN vec3 rotateDirection(vec3 d, ScatterAngle angle, float phi) {
    float s = d.z < 0.0F ? -1.0F : 1.0F;
    float a = -1.0F / (s + d.z);
    float b = d.x * d.y * a;
    vec3 tangent = vec3(1.0F + s * d.x * d.x * a, s * b, -s * d.x);
    vec3 bitangent = vec3(b, s + d.y * d.y * a, -d.y);
    vec3 across = angle.sinTheta * (cos(phi) * tangent + sin(phi) * bitangent);
    vec3 turned = (d - angle.oneMinusCos * d) + across;
    return turned * (1.5F - 0.5F * dot(turned, turned));
}

SHARED_END

#endif
