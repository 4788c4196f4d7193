#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"

namespace lumulus {

/// Levels that a mip-mapped picture of this size has: each is half as large as the one before, down to one pixel.
int mipLevels(int width, int height);

/// Encodes a picture with all its mip levels (tiles, ZIP, 32-bit float) as the bytes of an EXR file. `levels`:
/// mipLevels() of them, each max(1, width >> i) × max(1, height >> i); attributes are those of the first. `cubeMap`:
/// whether the header says that it is an environment map in the layout of OpenEXR's cube. Equal levels give equal
/// bytes.
std::vector<std::byte> encodeMipMapped(std::span<const LayeredImage> levels, bool cubeMap);

}  // namespace lumulus
