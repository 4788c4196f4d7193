#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/record.h"

namespace lumulus::bench {

/// A plot as the bytes of two files.
struct Plot {
    std::vector<std::byte> svg, png;
};

/// Plots relMSE against seconds on logarithmic axes: each method with both clocks, bars of one standard deviation over
/// the seeds, and the reference's noise as a line. Points at or below zero (below the noise of the reference) cannot be
/// drawn and are left out. Errors: Error if Cairo cannot draw.
Plot errorPlot(std::span<const Row> rows, const std::string& title, std::optional<double> floor);

}  // namespace lumulus::bench
