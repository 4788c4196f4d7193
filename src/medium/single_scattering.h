#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "medium/phase_function.h"

/// Single scattering of sunlight: exactly one scattering event by θc or more, with all forward scattering (by less than
/// θc) before and after it summed in small-angle form. With the true optical depths τs to the sun and τv to the eye,
/// per unit σs and irradiance:
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

/// The coefficients of the series, for terms l = 0..size−1.
struct SingleScatteringSeries {
    std::vector<double> inside;   ///< a_l
    std::vector<double> outside;  ///< b_l
    std::vector<double> disc;     ///< D_l
};

/// Computes as many terms as make the rest smaller than 1e−4 of the peak. There are 2^14 terms at most, which blur
/// sharper peaks by 0.005°. Angles are in radians.
SingleScatteringSeries makeSingleScatteringSeries(const PhaseFunction& phase, double thetaCut, double discRadius);

/// Computes the tables for an RGB albedo of one series, or of three, for red, green and blue. `forward` is the f of the
/// factor that the tables are divided by; `angleScale` and `tauMaximum` are those of the axes.
SingleScatteringTables makeSingleScatteringTables(std::span<const SingleScatteringSeries> series,
                                                  const glm::dvec3& albedo, double forward, double angleScale,
                                                  double tauMaximum);

}  // namespace lumulus::phase
