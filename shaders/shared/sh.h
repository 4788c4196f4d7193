// Real orthonormal spherical harmonics, up to 8 bands. Index i = l(l+1)+m; ∫ y_i y_j dω = δ_ij. Signs without the
// Condon–Shortley phase: y_1,−1, y_1,0, y_1,1 = √(3/4π)·(y, z, x); m > 0 goes with cos mφ, m < 0 with sin |m|φ.
#ifndef LUMULUS_SHARED_SH_H
#define LUMULUS_SHARED_SH_H

#include "shared/prelude.h"

SHARED_BEGIN

const int shMaxBands = 8;
const int shMaxCoefficients = shMaxBands * shMaxBands;

/// Values of the first bands² harmonics at the unit vector d; elements from bands² on are not written. 1 ≤ bands ≤ 8.
/// Call it with a constant (or specialisation constant) number of bands: what is left is straight-line code.
/// The recurrence in l works on the whole function, not on the Legendre part (after Sloan 2013, "Efficient Spherical
/// Harmonic Evaluation"): y_lm = A z y_l−1,m − B y_l−2,m with A² = (4l²−1)/(l²−m²),
/// B² = (2l+1)((l−1)²−m²)/((2l−3)(l²−m²)), A only √(2l+1) at m = l−1, and for m = ±l (x+iy) times the pair ±(l−1),
/// times √((2l+1)/2l).
SHARED_FN void shEvaluate(int bands, vec3 d, OUT_ARRAY(float, y, shMaxCoefficients)) {
#define SH_ZONAL(l, a, b) y[l * (l + 1)] = a * d.z * y[(l - 1) * l] - b * y[(l - 2) * (l - 1)]
#define SH_PAIR(l, m, a, b)                                                           \
    y[l * (l + 1) + m] = a * d.z * y[(l - 1) * l + m] - b * y[(l - 2) * (l - 1) + m]; \
    y[l * (l + 1) - m] = a * d.z * y[(l - 1) * l - m] - b * y[(l - 2) * (l - 1) - m]
#define SH_EDGE(l, a, s)                                                      \
    y[l * l + 2 * l - 1] = a * d.z * y[l * l - 1];                            \
    y[l * l + 1] = a * d.z * y[l * l - 2 * l + 1];                            \
    y[l * l + 2 * l] = s * (d.x * y[l * l - 1] - d.y * y[l * l - 2 * l + 1]); \
    y[l * l] = s * (d.x * y[l * l - 2 * l + 1] + d.y * y[l * l - 1])

    y[0] = 0.2820947918F;
    if (bands > 1) {
        y[1] = 0.4886025119F * d.y;
        y[2] = 0.4886025119F * d.z;
        y[3] = 0.4886025119F * d.x;
    }
    if (bands > 2) {
        SH_ZONAL(2, 1.936491673F, 1.118033989F);
        SH_EDGE(2, 2.236067977F, 1.118033989F);
    }
    if (bands > 3) {
        SH_ZONAL(3, 1.972026594F, 1.018350154F);
        SH_PAIR(3, 1, 2.091650066F, 0.9354143467F);
        SH_EDGE(3, 2.645751311F, 1.08012345F);
    }
    if (bands > 4) {
        SH_ZONAL(4, 1.984313483F, 1.00623059F);
        SH_PAIR(4, 1, 2.049390153F, 0.9797958971F);
        SH_PAIR(4, 2, 2.291287847F, 0.8660254038F);
        SH_EDGE(4, 3.0F, 1.060660172F);
    }
    if (bands > 5) {
        SH_ZONAL(5, 1.989974874F, 1.002853073F);
        SH_PAIR(5, 1, 2.031009601F, 0.991031209F);
        SH_PAIR(5, 2, 2.171240593F, 0.947607083F);
        SH_PAIR(5, 3, 2.487468593F, 0.8291561976F);
        SH_EDGE(5, 3.31662479F, 1.048808848F);
    }
    if (bands > 6) {
        SH_ZONAL(6, 1.993043457F, 1.001542021F);
        SH_PAIR(6, 1, 2.021314989F, 0.9952267031F);
        SH_PAIR(6, 2, 2.113941816F, 0.9736101205F);
        SH_PAIR(6, 3, 2.301368353F, 0.9251848887F);
        SH_PAIR(6, 4, 2.673948391F, 0.8062257748F);
        SH_EDGE(6, 3.605551275F, 1.040833F);
    }
    if (bands > 7) {
        SH_ZONAL(7, 1.994891435F, 1.000927214F);
        SH_PAIR(7, 1, 2.015564437F, 0.997155044F);
        SH_PAIR(7, 2, 2.081665999F, 0.9847319278F);
        SH_PAIR(7, 3, 2.207940217F, 0.9594032236F);
        SH_PAIR(7, 4, 2.430862174F, 0.9090909091F);
        SH_PAIR(7, 5, 2.850438563F, 0.790569415F);
        SH_EDGE(7, 3.872983346F, 1.035098339F);
    }
#undef SH_ZONAL
#undef SH_PAIR
#undef SH_EDGE
}

SHARED_END

#endif
