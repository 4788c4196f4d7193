#pragma once

#include <vector>

#include "medium/phase_function.h"

/// The sun as a uniform disc, and phase functions averaged over that disc.
namespace lumulus::phase {

/// Legendre moments D_l, l = 0..count−1, of a uniform disc of the given angular radius [radians], D_0 = 1; all 1 for
/// radius 0. D_l = (P_l−1(cos r) − P_l+1(cos r)) / ((2l+1)(1 − cos r)).
std::vector<double> discMoments(double radius, int count);

/// The mean of p over a disc of the given angular radius [radians] whose middle is seen under the scattering angle
/// theta [radians], in 1/sr; p(theta) itself for radius 0.
double averageOverDisc(const PhaseFunction& phase, double theta, double radius);

}  // namespace lumulus::phase
