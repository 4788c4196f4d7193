#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/image.h"

namespace lumulus {

/// Writes every layer as a 32-bit float channel of its name, scanline, ZIP; attributes as strings in the header.
/// The same image makes the same bytes. Errors: those of writeFile; InputError where an attribute has a name that the
/// format keeps for itself.
void writeExr(const std::filesystem::path& path, const LayeredImage& image);

/// The bytes of that file. Errors: InputError as above, with `name` for the picture.
std::vector<std::byte> encodeExr(const LayeredImage& image, const std::string& name);

/// Reads the first part of an EXR file: any compression, scanline or tiled (the full resolution), half, float or
/// unsigned channels, any data window (which becomes the picture). String attributes come along.
/// Errors: InputError for what is unreadable, truncated, deep, subsampled or too large (2^28 values).
LayeredImage readExr(const std::filesystem::path& path);

}  // namespace lumulus
