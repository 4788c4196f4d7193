#pragma once

#include <filesystem>
#include <string>

#include "base/image.h"

namespace lumulus::cli {

struct CompareOptions {
    std::filesystem::path image;
    std::filesystem::path reference;
    std::filesystem::path secondReference;  ///< empty, or an independent reference that removes the noise of both
    std::filesystem::path denominator;  ///< empty for the reference, or a picture that relative errors are relative to
    std::filesystem::path diff;         ///< empty, or file for the difference: false colours (.png), I − R (.exr)
    double exposure = 0.0;              ///< stops, for the tone-mapped pictures that FLIP compares
    bool self = false;                  ///< no reference: what the picture's own header states of its error
    bool json = false;
};

/// Runs `lumulus compare`: measures the error of a picture. Errors: InputError for pictures that do not fit.
void runCompare(const CompareOptions& options);

/// What `lumulus compare --json` tells of a picture and a reference. Errors: those of reference::compare.
std::string comparisonJson(const LayeredImage& image, const LayeredImage& truth, double exposure);

}  // namespace lumulus::cli
