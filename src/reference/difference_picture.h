#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace lumulus::reference {

/// The signed relative difference of the luminance, (I − R)/(|R| + .01·mean R), as colours for people: blue where the
/// picture is too dark, red where it is too bright, white where it agrees. Colours go with the root of the difference:
/// 1 % shows as a tenth of the full colour, 100 % and more as all of it. width·height·3 bytes of sRGB, rows from the
/// top.
std::vector<std::uint8_t> differencePicture(const LayeredImage& image, const LayeredImage& reference);

}  // namespace lumulus::reference
