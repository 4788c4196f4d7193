#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"

namespace lumulus::reference {

/// An error measure and, if variance layers tell the noise of the pictures, its standard error.
struct Measure {
    double value = 0.0;
    std::optional<double> standardError;
};

/// The difference d = I − R in radiance between a picture I and a reference R, over the pixels where the reference's
/// transmittance is below 0.999 and its layer sun.disc is 0 (all pixels if it has no such layers); channels R, G, B. D
/// is the picture of the denominators: R, or a picture with less noise.
struct Comparison {
    std::size_t pixels = 0;  ///< number of compared pixels
    double meanReference = 0.0;
    Measure rmse;          ///< √ mean d²
    Measure relMse;        ///< mean d² / (D² + .01·mean(D)²)
    Measure bias;          ///< mean d
    Measure relativeBias;  ///< mean d / mean R
    Measure mape;          ///< mean |d| / (|D| + .01·mean D); relative measures of black pictures are 0 or infinite
    /// The relMSE that noise alone makes, by the variance layers of the picture and of the reference.
    std::optional<double> imageNoise, referenceNoise;
};

/// A picture and its name in messages.
struct NamedImage {
    const LayeredImage& image;
    std::string name;
};

/// The pixels in which `shown` has a cloud or fog (a transmittance below 0.999) and `reference` none of the sun's disc.
std::vector<std::size_t> cloudPixels(const LayeredImage& shown, const LayeredImage& reference);

/// Checks that two pictures can be compared. Errors: InputError if a picture has no layers R, G, B, if a layer holds
/// NaN, infinity or a negative variance (the message names layer and pixel), or if sizes differ.
void requireComparable(const NamedImage& image, const NamedImage& reference);

/// Compares a picture with one reference. Standard errors take pixels as independent and the channels of a pixel as
/// fully correlated (one path carries all three), which is on the safe side. The pictures have passed
/// requireComparable. `denominator`, where it is given, is D, and its transmittance instead of the reference's says
/// which pixels count: references of few samples have noise in both, so that relMSE would depend on their number of
/// samples. Errors: InputError if no pixel is left to compare.
Comparison compare(const LayeredImage& image, const LayeredImage& reference, const LayeredImage* denominator = nullptr);

/// Compares a picture with two independent references A and B of the same scene: (I−A)(I−B) replaces d², which frees
/// rmse and relMse of the references' noise (relMse may be negative by chance; rmse is 0 then); R = (A+B)/2.
Comparison compare(const LayeredImage& image, const LayeredImage& referenceA, const LayeredImage& referenceB,
                   const LayeredImage* denominator = nullptr);

}  // namespace lumulus::reference
