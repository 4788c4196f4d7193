#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/image.h"

namespace lumulus::reference {

/// An error measure and, where variance layers say how noisy the pictures are, its standard error.
struct Measure {
    double value = 0.0;
    std::optional<double> standardError;
};

/// How far a picture I is from a reference R: over pixels and channels R, G, B where the reference's transmittance is
/// below .999 and its layer sun.disc 0 (everywhere where it has no such layers); d = I − R, in radiance. D is the
/// picture of the denominators: R, or a picture with less noise.
struct Comparison {
    std::size_t pixels = 0;  ///< that were compared
    double meanReference = 0.0;
    Measure rmse;          ///< √ mean d²
    Measure relMse;        ///< mean d² / (D² + .01·mean(D)²)
    Measure bias;          ///< mean d
    Measure relativeBias;  ///< mean d / mean R
    Measure mape;          ///< mean |d| / (|D| + .01·mean D); relative measures of black pictures are 0 or infinite
    /// The relMSE that noise alone makes, by the variance layers of the picture and of the reference.
    std::optional<double> imageNoise, referenceNoise;
};

/// A picture and what to call it in messages.
struct NamedImage {
    const LayeredImage& image;
    std::string name;
};

/// Errors: InputError where a picture has no layers R, G, B, where a layer that is used holds NaN or infinity, or a
/// variance below 0 (it says which layer and where), and where sizes differ.
void requireComparable(const NamedImage& image, const NamedImage& reference);

/// The measures against one reference. Standard errors take pixels as independent and the channels of a pixel as fully
/// correlated (one path carries all three), which is on the safe side. The pictures have passed requireComparable.
/// `denominator`, where it is given, is D, and its transmittance instead of the reference's says which pixels count:
/// references of few samples have noise in both, so that relMSE would depend on their number of samples.
/// Errors: InputError where no pixel is left to compare.
Comparison compare(const LayeredImage& image, const LayeredImage& reference, const LayeredImage* denominator = nullptr);

/// The same against two independent references A and B of the same scene: (I−A)(I−B) takes the place of d², which frees
/// rmse and relMse of the references' noise (they may come out negative by chance; rmse is 0 then); R = (A+B)/2.
Comparison compare(const LayeredImage& image, const LayeredImage& referenceA, const LayeredImage& referenceB,
                   const LayeredImage* denominator = nullptr);

}  // namespace lumulus::reference
