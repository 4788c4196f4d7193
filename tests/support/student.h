#pragma once

#include <cmath>

namespace lumulus::test {

/// The normal deviate that is as unlikely as a value t of Student's distribution (Wallace 1959): so that bounds in
/// standard deviations hold for errors that are estimated from a few values.
inline double studentDeviation(double t, double freedom) {
    const double size =
        (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0) * std::sqrt(freedom * std::log1p(t * t / freedom));
    return std::copysign(size, t);
}

}  // namespace lumulus::test
