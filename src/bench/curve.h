#pragma once

#include <optional>
#include <span>

namespace lumulus::bench {

/// An error that was measured after so many seconds.
struct CurvePoint {
    double seconds = 0.0;
    double error = 0.0;
};

enum class Reached {
    measured,      ///< between two points, interpolated
    atFirst,       ///< the first point is already there: the time is an upper bound
    extrapolated,  ///< beyond the last point, if the error goes on falling with the samples
    never,         ///< no point is there, and nothing says that longer runs would be
};

struct TimeToError {
    Reached how = Reached::never;
    double seconds = 0.0;
};

/// The seconds after which the error is first down to `target` (> 0). Points in order of time; between two of them the
/// curve is straight on doubly logarithmic paper. An error of 0 or less (it came out below the noise of the reference)
/// counts as reached at its own time. `fixedSeconds`, given where the error is variance alone: beyond the last point it
/// falls as 1/(time − fixedSeconds).
TimeToError timeToReach(std::span<const CurvePoint> curve, double target, std::optional<double> fixedSeconds);

}  // namespace lumulus::bench
