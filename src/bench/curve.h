#pragma once

#include <optional>
#include <span>

namespace lumulus::bench {

/// An error with the time after which it was measured.
struct CurvePoint {
    double seconds = 0.0;
    double error = 0.0;
};

enum class Reached {
    measured,      ///< between two points, interpolated
    atFirst,       ///< the first point is already below the target: the time is an upper bound
    extrapolated,  ///< beyond the last point, assuming that the error is variance alone
    never,         ///< no point reaches the target, and longer runs need not reach it
};

struct TimeToError {
    Reached how = Reached::never;
    double seconds = 0.0;
};

/// Finds the seconds after which the error first falls to `target` (> 0). Points are in order of time; between two
/// points the curve is straight on doubly logarithmic paper. An error of 0 or less (below the noise of the reference)
/// counts as reached at its own time. If `fixedSeconds` is given, the error is variance alone and falls as 1/(time −
/// fixedSeconds) beyond the last point.
TimeToError timeToReach(std::span<const CurvePoint> curve, double target, std::optional<double> fixedSeconds);

}  // namespace lumulus::bench
