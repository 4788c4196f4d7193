#pragma once

#include <cstdint>
#include <filesystem>

#include "reference/film.h"

namespace lumulus::reference {

/// The file beside a picture that keeps the exact sums: its name and ".sums".
std::filesystem::path sumsBeside(const std::filesystem::path& picture);

/// Writes the film bit by bit. `fingerprint` says what was rendered. Errors: those of writeFile.
void writeFilm(const std::filesystem::path& path, const Film& film, std::uint64_t fingerprint);

/// Reads what writeFilm wrote. Errors: InputError for a file that is missing, damaged, or of another fingerprint.
Film readFilm(const std::filesystem::path& path, std::uint64_t fingerprint);

}  // namespace lumulus::reference
