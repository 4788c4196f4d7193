#pragma once

#include <optional>
#include <span>
#include <string>

#include "bench/record.h"

namespace lumulus::bench {

/// The table for the terminal: the rows, the reference's noise (relMSE, if known), and the time to a relMSE of 1e-2 and
/// 3e-3 by both clocks with the ratio of the methods. A time beyond the last point of a path tracer is extrapolated
/// (its error is variance and falls as 1/samples) and marked ~. A time that the first point already meets is an upper
/// bound and marked ≤.
std::string tableText(std::span<const Row> rows, std::optional<double> floor);

}  // namespace lumulus::bench
