#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace lumulus {

/// Tone maps the layers R, G, B (linear Rec. 709 radiance) to 8-bit sRGB: exposure in photographic stops, the filmic
/// curve of Narkowicz (2015, "ACES filmic tone mapping curve"), the sRGB transfer function (IEC 61966-2-1), and a
/// dither that depends on the pixel alone. Returns width·height·3 bytes, rows from the top. NaN and negative values
/// become black, infinity white.
std::vector<std::uint8_t> toneMap(const LayeredImage& image, double exposureStops);

/// Tone maps a picture whose R, G, B are premultiplied by its layer A: colours divided by A are mapped as by toneMap,
/// and A is rounded to 8 bits, linear. Returns width·height·4 bytes, rows from the top, as PNG wants them. Where A is 0
/// all four are 0.
std::vector<std::uint8_t> toneMapWithAlpha(const LayeredImage& image, double exposureStops);

}  // namespace lumulus
