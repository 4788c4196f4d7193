#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace lumulus {

/// 8-bit sRGB as a PNG file, `rgb` of width·height·3 bytes, rows from the top. The same input makes the same bytes.
/// Errors: Error where the library fails.
std::vector<std::byte> encodePng(int width, int height, std::span<const std::uint8_t> rgb);

/// Writes what encodePng makes. Errors: those of writeFile too.
void writePng(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace lumulus
