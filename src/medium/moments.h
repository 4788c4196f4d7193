#pragma once

#include <vector>

/// Legendre moments χ_l = ∫ p P_l dω, l = 0..count−1, in closed form; χ_0 = 1.
namespace lumulus::phase {

std::vector<double> hgMoments(double g, int count);

/// Draine 2003, Henyey–Greenstein times (1 + α c²): METHODS' formula, from c² P_l in terms of P_l−2, P_l, P_l+2.
std::vector<double> draineMoments(double g, double alpha, int count);

/// Schlick's 1/(1−kc)², |k| < 1: χ_l = l (Q_l−1(1/k) − Q_l(1/k)/k), Q_l the Legendre functions of the second kind.
std::vector<double> schlickMoments(double k, int count);

/// (n+1)/4π · ((1+c)/2)ⁿ: χ_l = n!(n+1)! / ((n−l)!(n+l+1)!).
std::vector<double> powerLobeMoments(int n, int count);

}  // namespace lumulus::phase
