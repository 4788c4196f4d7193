#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/image.h"

namespace lumulus {

/// Writes each layer as a 32-bit float channel of the same name (scanlines, ZIP) and attributes as strings in the
/// header. Equal images give equal bytes. Errors: those of writeFile; InputError where an attribute has a name that the
/// format reserves.
void writeExr(const std::filesystem::path& path, const LayeredImage& image);

/// Encodes an image as the bytes of an EXR file. Errors: InputError as for writeExr; `name` is the picture in messages.
std::vector<std::byte> encodeExr(const LayeredImage& image, const std::string& name);

/// Reads the first part of an EXR file: any compression, scanline or tiled (the full resolution), half, float or
/// unsigned channels, any data window (which becomes the picture). String attributes are read too.
/// Errors: InputError for a file that is unreadable, truncated, deep, subsampled or too large (2^28 values).
LayeredImage readExr(const std::filesystem::path& path);

}  // namespace lumulus
