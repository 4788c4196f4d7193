#pragma once

#include <array>
#include <functional>
#include <vector>

namespace lumulus::fog_change {

/// Bands of spherical harmonics in which light is known by direction.
constexpr int bandCount = 6;

/// A phase function whose forward peak counts as light that is not scattered: nearer than an angle to straight on it
/// stays at its value there.
class CutPhase {
  public:
    /// `phase`: by the cosine of the angle, in any unit. `cut`: radians.
    CutPhase(const std::function<double(double)>& phase, double cut);

    /// Share of scattered light in the peak that is cut off.
    double peak() const { return peak_; }
    /// Mean cosine of the light in that peak; 1 where there is none.
    double peakCosine() const { return peakCosine_; }
    /// Moments of what is left.
    const std::array<double, bandCount>& moments() const { return moments_; }
    /// What is left, by the cosine of the angle [1/sr].
    double value(double cosine) const;
    /// A cosine of what is left, from a number in [0, 1).
    double sampleCosine(double u) const;

  private:
    double peak_ = 0.0, peakCosine_ = 1.0;
    std::array<double, bandCount> moments_{};
    std::vector<double> values_;   ///< at even steps of the root of the angle
    std::vector<double> cosines_;  ///< at equal shares of the light
};

}  // namespace lumulus::fog_change
