#pragma once

#include <cstdint>
#include <filesystem>

#include "reference/film.h"

namespace lumulus::reference {

/// Name of the file beside a picture that holds the exact sums: the picture's name and ".sums".
std::filesystem::path sumsBeside(const std::filesystem::path& picture);

/// Writes the film with all bits. `fingerprint` identifies scene and settings. Errors: those of writeFile.
void writeFilm(const std::filesystem::path& path, const Film& film, std::uint64_t fingerprint);

/// Reads a film of writeFilm. Errors: InputError for a file that is missing, damaged, or has another fingerprint.
Film readFilm(const std::filesystem::path& path, std::uint64_t fingerprint);

}  // namespace lumulus::reference
