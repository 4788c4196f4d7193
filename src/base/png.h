#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace lumulus {

/// Encodes 8-bit sRGB as a PNG file. `pixels` has width·height·3 bytes, or width·height·4 with an alpha that is not
/// multiplied into the colours; rows from the top. Equal input gives equal bytes. Errors: Error where the library
/// fails.
std::vector<std::byte> encodePng(int width, int height, std::span<const std::uint8_t> pixels);

/// Writes the result of encodePng to a file. Errors: those of encodePng and writeFile.
void writePng(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> pixels);

}  // namespace lumulus
