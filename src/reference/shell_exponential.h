#pragma once

#include <vector>

#include "reference/medium.h"
#include "view/camera.h"

namespace lumulus::reference {

/// A density that falls exponentially with the height above a round planet, along a part of one ray: its integral and
/// the inverse of it. Gauss's rule, relative error below 1e-7. As in AirPath places are counted by u, where the height
/// is that of the line's lowest point plus u².
class ShellExponential {
  public:
    /// The density is e^(−rate (y − zero)), y the height above the planet's surface plus `ground`. `rate`: 1/m, below
    /// zero where the density grows upwards. `part`: metres of the ray, whose end is finite where the rate is below
    /// zero.
    ShellExponential(double rate, double zero, double ground, const Ray& ray, const Interval& part);

    /// The integral from the beginning of the part to `metres`.
    double pathTo(double metres) const;

    /// Metres at which the integral reaches `path`; infinity if it never does.
    double metresTo(double path) const;

  private:
    double placeOf(double metres) const;
    double metresAt(double u) const;
    std::vector<double> breaks(double begin, double end) const;
    void breakMonotone(double near, double far, std::vector<double>& to) const;
    double piece(double begin, double end) const;
    /// Density times the metres for a step of one in u.
    double densityAt(double u) const;

    double rate_;
    double lowestRadius_;  ///< of the line, from the planet's middle
    double exponent_;      ///< −ln of the density at the line's lowest point
    double middle_;        ///< metres of the ray to the lowest point
    double begin_, end_;   ///< places
};

}  // namespace lumulus::reference
