#pragma once

#include <vector>

namespace lumulus::reference {

/// A phase function by values: p is linear in 1 − cos θ between them, so that its distribution is inverted exactly.
class PhaseValues {
  public:
    /// `oneMinusCos` rises from 0 to 2; `values` of any unit become p [1/sr] with ∫ p dω = 1.
    PhaseValues(std::vector<double> oneMinusCos, std::vector<double> values);

    double evaluate(double oneMinusCos) const;

    /// 1 − cos θ below which the share `u` in [0,1) of the light is scattered.
    double invert(double u) const;

    double forward() const { return values_.front(); }

  private:
    std::vector<double> places_, values_;
    std::vector<double> below_;  ///< share of the light that is scattered by less than each place
};

}  // namespace lumulus::reference
