#pragma once

#include <cstddef>
#include <vector>

namespace lumulus::phase {

/// A phase function as values at angles, linear between them, with ∫ p dω = 1.
class TabulatedPhase {
  public:
    /// `angles` in radians, rising from 0 to π; `values` per solid angle, 0 or more and not all 0, in any unit.
    TabulatedPhase(std::vector<double> angles, std::vector<double> values);

    /// p [1/sr] at an angle in [0,π].
    double evaluate(double theta) const;

    /// What the values were multiplied by so that p is normalised.
    double factor() const { return factor_; }

    const std::vector<double>& angles() const { return angles_; }
    const std::vector<double>& values() const { return values_; }

    /// 2π ∫ p P_l(cos θ) sin θ dθ over [begin,end], l = 0..count−1; runs on all threads.
    std::vector<double> moments(double begin, double end, int count) const;

    /// The angle within which p falls to half of its forward value, at most 0.25 [radians].
    double lobeWidth() const;

  private:
    std::size_t cellOf(double theta) const;

    std::vector<double> angles_, values_;
    std::vector<std::size_t> first_;  ///< cell in which the n-th part of [0,π] begins
    double factor_ = 1.0;
};

}  // namespace lumulus::phase
