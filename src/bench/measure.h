#pragma once

#include <optional>
#include <string>

#include "base/image.h"
#include "bench/record.h"

namespace lumulus::bench {

/// The picture that others are measured against, with its own noise.
struct Truth {
    LayeredImage image;
    std::string name;             ///< for messages
    double exposure = 0.0;        ///< stops, of the tone-mapped pictures that FLIP sees
    std::optional<double> floor;  ///< relMSE that the reference's noise alone makes, by its variance layers
};

/// Errors: InputError for a picture that cannot be compared with (reference::requireComparable), of another size, or
/// black.
Truth makeTruth(LayeredImage image, std::string name, int width, int height, double exposure);

/// Errors: InputError where the picture holds NaN.
Errors measure(const LayeredImage& image, const Truth& truth);

}  // namespace lumulus::bench
