#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "render/renderer.h"

namespace lumulus::cli {

/// Where a progressive picture stopped.
struct ProgressiveStatistics {
    std::string stop;             ///< "photons", "seconds" or "target-error"
    std::optional<double> noise;  ///< relMSE of the photons' noise, where it is known
    double biasEstimate = 0.0;    ///< relMSE
    double previewSeconds = 0.0;  ///< spent on estimating the noise
};

/// What --stats writes: one JSON object and a newline. Seconds of writing and of everything come from the caller.
std::string statisticsJson(const Statistics& statistics, const std::optional<ProgressiveStatistics>& progressive,
                           double writeSeconds, double totalSeconds);

/// Writes the JSON where --stats says: a file, "-" for stdout, nowhere if empty. Errors: those of writing.
void writeStatistics(const std::string& where, const std::string& json);

/// What --validate asks for. Errors: Error with the first message of the validation layer, where there is one.
void requireNoMessages(bool validate, const Statistics& statistics);

}  // namespace lumulus::cli
