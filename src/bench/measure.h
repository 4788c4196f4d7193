#pragma once

#include <optional>
#include <string>

#include "base/image.h"
#include "bench/record.h"

namespace lumulus::bench {

/// The reference picture and its own noise.
struct Truth {
    LayeredImage image;
    std::string name;             ///< for messages
    double exposure = 0.0;        ///< stops, for the tone-mapped pictures that FLIP compares
    std::optional<double> floor;  ///< relMSE of the reference's noise, by its variance layers
};

/// Checks and measures a reference. Errors: InputError if it cannot be compared with (reference::requireComparable),
/// has another size, or is black.
Truth makeTruth(LayeredImage image, std::string name, int width, int height, double exposure);

/// Measures the errors of a picture. Errors: InputError if the picture holds NaN.
Errors measure(const LayeredImage& image, const Truth& truth);

}  // namespace lumulus::bench
