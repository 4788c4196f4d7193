#include "medium/axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::phase {

double axisToAngle(double x, double scale) {
    // (s + 2 sin θ/2) / (s + 2 cos θ/2) = r gives 2 √(1+r²) sin(θ/2 − atan r) = s (r−1)
    const double r = std::exp((2.0 * x - 1.0) * std::log1p(2.0 / scale));
    const double half = std::atan(r) + std::asin(scale * (r - 1.0) / (2.0 * std::hypot(1.0, r)));
    return std::clamp(2.0 * half, 0.0, std::numbers::pi);
}

double axisToTau(double x, double tauMaximum) {
    return std::expm1(x * std::log1p(tauMaximum));
}

}  // namespace lumulus::phase
