#pragma once

#include <algorithm>
#include <cmath>

namespace lumulus::sky {

/// Steps along a ray through the air: short where it is lowest, growing with the root of the distance from there. They
/// move without a jump between rays that go a little down and a little up.
class PathSteps {
  public:
    /// `lowest`: distance to the lowest point, which may lie before or behind the path of `length` metres.
    PathSteps(double length, double lowest, int count)
        : low_(std::clamp(lowest, 0.0, length)),
          begin_(-std::sqrt(low_)),
          width_((std::sqrt(length - low_) - begin_) / count) {}

    /// Where step `i` looks at the air [m].
    double middle(int i) const { return at(begin_ + (i + 0.5) * width_); }
    double length(int i) const { return at(begin_ + (i + 1) * width_) - at(begin_ + i * width_); }

  private:
    double at(double root) const { return low_ + root * std::abs(root); }
    double low_, begin_, width_;
};

}  // namespace lumulus::sky
