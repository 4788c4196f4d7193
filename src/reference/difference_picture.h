#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace lumulus::reference {

/// Shows the signed relative difference of the luminance, (I − R)/(|R| + 0.01·mean R), in colours: blue where the
/// picture is too dark, red where it is too bright, white where it agrees. Colours grow with the root of the
/// difference: 1 % has a tenth of the full colour, 100 % and more all of it. Returns width·height·3 bytes of sRGB, rows
/// from the top.
std::vector<std::uint8_t> differencePicture(const LayeredImage& image, const LayeredImage& reference);

}  // namespace lumulus::reference
