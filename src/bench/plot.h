#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/record.h"

namespace lumulus::bench {

/// A picture as the bytes of two files that show the same.
struct Plot {
    std::vector<std::byte> svg, png;
};

/// relMSE against seconds, both axes logarithmic: each method by both clocks, bars of one standard deviation over the
/// seeds, the reference's noise floor as a line. Points at or below zero (below the noise of the reference) cannot be
/// drawn and are left out. Errors: Error where Cairo cannot draw.
Plot errorPlot(std::span<const Row> rows, const std::string& title, std::optional<double> floor);

}  // namespace lumulus::bench
