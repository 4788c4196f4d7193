#pragma once

#include <vector>

#include "reference/phase_values.h"

namespace lumulus::reference {

/// Phase functions of droplets of water: of red, green, blue, and their mean by the luminance of sunlight.
struct Droplets {
    std::vector<PhaseValues> colours;  ///< four
};

/// The reference's own Mie theory: coefficients by ratios of Riccati–Bessel functions (Du 2004) instead of logarithmic
/// derivatives, and the trapezoid rule over the radii. `radius` (effective, µm) and `variance` of a gamma distribution.
Droplets makeDroplets(double radius, double variance);

}  // namespace lumulus::reference
