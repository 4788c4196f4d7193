#pragma once

#include <optional>
#include <span>
#include <string>

#include "bench/record.h"

namespace lumulus::bench {

/// What the terminal shows: the rows, the reference's noise floor (relMSE, where known), and the time to reach relMSE
/// 1e-2 and 3e-3 by both clocks with the ratio of the methods. A time beyond the last point of a path tracer is
/// extrapolated (its error is variance: it falls as 1/samples) and marked ~; one that the first point already meets is
/// an upper bound and marked ≤.
std::string tableText(std::span<const Row> rows, std::optional<double> floor);

}  // namespace lumulus::bench
