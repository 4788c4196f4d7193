#pragma once

#include <optional>
#include <span>
#include <string>

#include "bench/record.h"

namespace lumulus::bench {

/// relMSE against seconds as SVG, both axes logarithmic: each method by both clocks, bars of one standard deviation
/// over the seeds, the reference's noise floor as a line. Points at or below zero (below the noise of the reference)
/// cannot be drawn and are left out.
std::string errorPlotSvg(std::span<const Row> rows, const std::string& title, std::optional<double> floor);

}  // namespace lumulus::bench
