#pragma once

#include <cmath>
#include <cstddef>

namespace lumulus::test {

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
