#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/render_error.h"
#include "render/renderer.h"

namespace lumulus::cli {

/// Result of a progressive picture.
struct ProgressiveStatistics {
    std::string stop;             ///< "photons", "seconds" or "target-error"
    std::optional<double> noise;  ///< relMSE of the photons' noise, if known
    double previewSeconds = 0.0;  ///< spent on estimating the noise
};

/// The text for --stats: one JSON object and a newline. The caller gives the seconds of writing and of the whole run,
/// and what it made of the error, or null.
std::string statisticsJson(const Statistics& statistics, const std::optional<ProgressiveStatistics>& progressive,
                           double writeSeconds, double totalSeconds, const ErrorOfPicture* error = nullptr);

/// Writes the JSON to the place of --stats: a file, stdout for "-", nowhere if empty. Errors: those of writing.
void writeStatistics(const std::string& where, const std::string& json);

/// Throws Error with the first message of the validation layer, if there is one and --validate was given.
void requireNoMessages(bool validate, const Statistics& statistics);

}  // namespace lumulus::cli
