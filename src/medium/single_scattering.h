#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "medium/phase_function.h"

/// The sun's light with exactly one turn (a scattering by θc or more), all forward scatterings before and after it
/// summed (small-angle form). With the true optical depths τs to the sun and τv to the eye, per unit σs and irradiance:
///   p(θ) e^−(τs+τv) + H(τs,θ) e^−τv + K(τs+τv,θ),
///   H(τ,θ) = e^−τ Σ_l (2l+1)/4π a_l (e^(ω a_l τ) − 1) P_l(cos θ) D_l, K the same with b_l = χ_l − a_l in front of the
/// bracket, a_l = ∫_θ<θc p P_l dω, ω the albedo, and D_l the moments of the sun's disc.
namespace lumulus::phase {

/// The smooth parts H and K on the axes of shared/phase_table.h (singleScatterIndex), divided by e^−(1−ωf)τ: numbers of
/// the order of p that tend to a constant at large τ.
struct SingleScatteringTables {
    std::vector<float> h;
    std::vector<float> k;
};

/// What the series is made of: terms l = 0..size−1.
struct SingleScatteringSeries {
    std::vector<double> inside;   ///< a_l
    std::vector<double> outside;  ///< b_l
    std::vector<double> disc;     ///< D_l
};

/// The terms, as many as make the rest smaller than 1e−4 of the peak (2^14 at most, which blurs by .005° what is
/// sharper). Angles in radians.
SingleScatteringSeries makeSingleScatteringSeries(const PhaseFunction& phase, double thetaCut, double discRadius);

/// The tables for RGB albedo; `angleScale` and `tauMaximum` are those of the axes.
SingleScatteringTables makeSingleScatteringTables(const SingleScatteringSeries& series, const glm::dvec3& albedo,
                                                  double angleScale, double tauMaximum);

}  // namespace lumulus::phase
