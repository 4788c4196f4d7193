#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"

namespace lumulus::cli {

/// True for a file name that ends so; upper and lower case are the same.
bool hasSuffix(const std::filesystem::path& path, std::string_view suffix);

/// Throws InputError where the name ends with none of the suffixes.
void requireSuffix(const std::filesystem::path& path, std::initializer_list<std::string_view> suffixes);

/// Everything that can be known before the work of the places that files will be written to.
/// Errors: InputError where two of them are one file, by whatever names, or one cannot be written to.
void checkPlaces(const std::vector<std::filesystem::path>& outputs);

/// Writes a picture by its suffix: .exr with all layers, or .png tone mapped. Errors: those of writing files.
void writePicture(const std::filesystem::path& path, const LayeredImage& image, double exposure);

/// Text on stdout. Errors: Error where it cannot be written (a full disk, a closed pipe).
void printOut(std::string_view text);

}  // namespace lumulus::cli
