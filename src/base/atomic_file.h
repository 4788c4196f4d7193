#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace lumulus {

/// Writes a whole file. A temporary file beside it is written, synchronised and renamed, so that the name never stands
/// for half a file. Symbolic links are followed; devices and pipes are written to directly.
/// Errors: InputError where the place cannot be written to, Error where writing fails (disk full). In both cases the
/// temporary file is removed and a file that existed before is unchanged.
void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Throws the InputError that writeFile would throw, before hours of work: makes the temporary file and removes it.
void checkWritable(const std::filesystem::path& path);

}  // namespace lumulus
