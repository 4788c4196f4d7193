#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "scene/scene.h"

namespace lumulus::scene {

/// The number of the file that a cloud shows at a frame; none where it is not there. Files are those nearest in time.
std::optional<std::int64_t> fileAt(const FileSequence& sequence, double frame, double fps);

/// The same with a fraction between two files; behind the last one of those that repeat it leads to the first.
std::optional<double> momentAt(const FileSequence& sequence, double frame, double fps);

/// Puts the file of a frame into the place of the sequence's name: the cloud then is that of this frame alone. Between
/// two files it is the one before, with the moment beside it. A file that has that very name is no sequence. Errors:
/// InputError for a file that is missing, with its number.
void chooseFile(Cloud& cloud, double frame, double fps, std::span<const std::filesystem::path> allowed,
                const std::string& where);

}  // namespace lumulus::scene
