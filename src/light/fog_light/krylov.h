#pragma once

#include <functional>
#include <vector>

namespace lumulus::fog_light {

using Vector = std::vector<double>;

/// Solves x = b + K x by GMRES (Saad and Schultz 1986), with a residual of `tolerance` times that of x = b.
Vector solveFixedPoint(const std::function<Vector(const Vector&)>& k, const Vector& b, double tolerance);

}  // namespace lumulus::fog_light
