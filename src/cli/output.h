#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exr.h"
#include "base/image.h"
#include "scene/scene.h"

namespace lumulus::cli {

/// True if a file name ends with the suffix; upper and lower case are equal.
bool hasSuffix(const std::filesystem::path& path, std::string_view suffix);

/// Throws InputError if the name ends with none of the suffixes.
void requireSuffix(const std::filesystem::path& path, std::initializer_list<std::string_view> suffixes);

/// Checks the places of output files before the work.
/// Errors: InputError if two of them are the same file, by any names, or if one cannot be written to.
void checkPlaces(const std::vector<std::filesystem::path>& outputs);

/// Writes a picture by its suffix: .exr with all layers, or .png with the exposure and tone map of `how`, and with
/// alpha where `how` leaves the background out. `windows` are those of an EXR file. Errors: those of writing files.
void writePicture(const std::filesystem::path& path, const LayeredImage& image, const scene::Image& how,
                  const std::optional<ExrWindows>& windows = std::nullopt);

/// Writes text to stdout. A reader that has gone (`| head`) is no error: it has read enough. Errors: Error if the text
/// cannot be written (a full disk).
void printOut(std::string_view text);

}  // namespace lumulus::cli
