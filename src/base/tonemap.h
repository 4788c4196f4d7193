#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"
#include "base/tone_curves.h"

namespace lumulus {

class DisplayTransform;

/// How radiance becomes a picture of 8 bits.
struct Tone {
    double stops = 0.0;  ///< photographic stops
    double gain = 1.0;   ///< factor besides, as of an exposure value or a meter
    ToneCurve curve = ToneCurve::filmic;
    const DisplayTransform* display = nullptr;  ///< in the place of curve and transfer function, where there is one

    /// Factor for the radiance.
    double factor() const;
};

/// Tone maps the layers R, G, B (linear Rec. 709 radiance) to 8-bit sRGB: exposure, the curve, the sRGB transfer
/// function (IEC 61966-2-1), and a dither that depends on the pixel alone. Returns width·height·3 bytes, rows from the
/// top. NaN and negative values become black, infinity white.
std::vector<std::uint8_t> toneMap(const LayeredImage& image, const Tone& tone);

/// By the filmic curve with an exposure in photographic stops.
std::vector<std::uint8_t> toneMap(const LayeredImage& image, double exposureStops);

/// Tone maps a picture whose R, G, B are premultiplied by its layer A: colours divided by A are mapped as by toneMap,
/// and A is rounded to 8 bits, linear. Returns width·height·4 bytes, rows from the top, as PNG wants them. Where A is 0
/// all four are 0.
std::vector<std::uint8_t> toneMapWithAlpha(const LayeredImage& image, const Tone& tone);

}  // namespace lumulus
