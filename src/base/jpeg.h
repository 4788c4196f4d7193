#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumulus {

/// 8-bit sRGB as a JPEG file, `rgb` of width·height·3 bytes, rows from the top; `quality` 1 to 100.
/// Errors: Error where the library fails, as for sides beyond 65500.
std::vector<std::byte> encodeJpeg(int width, int height, std::span<const std::uint8_t> rgb, int quality);

}  // namespace lumulus
