#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumulus {

/// Encodes 8-bit sRGB as a JPEG file. `rgb` has width·height·3 bytes, rows from the top; `quality` is 1 to 100.
/// Errors: Error where the library fails, for instance for sides beyond 65500 pixels.
std::vector<std::byte> encodeJpeg(int width, int height, std::span<const std::uint8_t> rgb, int quality);

}  // namespace lumulus
