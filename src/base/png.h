#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace lumulus {

/// Writes 8-bit sRGB, `rgb` of width·height·3 bytes, rows from the top. The same input makes the same bytes.
/// Errors: those of writeFile.
void writePng(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace lumulus
