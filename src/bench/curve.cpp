#include "bench/curve.h"

#include <cmath>
#include <cstddef>

namespace lumulus::bench {

TimeToError timeToReach(std::span<const CurvePoint> curve, double target, std::optional<double> fixedSeconds) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const CurvePoint& here = curve[i];
        if (here.error > target) continue;
        if (i == 0) return {Reached::atFirst, here.seconds};
        if (here.error <= 0.0) return {Reached::measured, here.seconds};
        const CurvePoint& before = curve[i - 1];
        const double share = std::log(before.error / target) / std::log(before.error / here.error);
        return {Reached::measured, before.seconds * std::pow(here.seconds / before.seconds, share)};
    }
    if (curve.empty() || !fixedSeconds) return {};
    const CurvePoint& last = curve.back();
    return {Reached::extrapolated, *fixedSeconds + (last.seconds - *fixedSeconds) * last.error / target};
}

}  // namespace lumulus::bench
