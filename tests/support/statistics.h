#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace lumulus::test {

/// Pearson's χ² of counts against expected counts as a number of standard deviations (Wilson and Hilferty 1931: its
/// cube root is nearly normal). Neighbouring bins are joined until each expects at least 20. `fitted` degrees of
/// freedom go off for the total that both share.
inline double chiSquareDeviation(const std::vector<double>& observed, const std::vector<double>& expected,
                                 int fitted = 1) {
    double statistic = 0.0;
    double freedom = -fitted;
    double seen = 0.0;
    double due = 0.0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        seen += observed[i];
        due += expected[i];
        if (due >= 20.0 || (i + 1 == observed.size() && due > 0.0)) {
            statistic += (seen - due) * (seen - due) / due;
            freedom += 1.0;
            seen = 0.0;
            due = 0.0;
        }
    }
    if (seen > 0.0 || freedom < 1.0) {
        return INFINITY;  // samples where none can be, or nothing to compare
    }
    const double spread = 2.0 / (9.0 * freedom);
    return (std::cbrt(statistic / freedom) - (1.0 - spread)) / std::sqrt(spread);
}

/// Mean of a sample and the standard error of that mean.
class RunningMean {
  public:
    void add(double value) {
        ++count_;
        const double delta = value - mean_;
        mean_ += delta / static_cast<double>(count_);
        squares_ += delta * (value - mean_);
    }
    double mean() const { return mean_; }
    double standardError() const {
        const auto n = static_cast<double>(count_);
        return std::sqrt(squares_ / (n * (n - 1.0)));
    }

  private:
    std::size_t count_ = 0;
    double mean_ = 0.0;
    double squares_ = 0.0;
};

}  // namespace lumulus::test
