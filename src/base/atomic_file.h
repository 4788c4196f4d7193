#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace lumulus {

/// Writes a whole file. A temporary file beside it is written, synchronised and renamed, so that the name never stands
/// for half a file. Symbolic links are followed, also one whose target does not exist yet. A file that existed before
/// keeps its permissions, and its owner where the system allows that. Devices and pipes are written to directly;
/// a pipe whose reader goes away has been read enough.
/// Errors: InputError where the place cannot be written to or the file there may not be, Error where writing fails
/// (disk full). In both cases the temporary file is removed and a file that existed before is unchanged.
void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// The file that writeFile would write: its absolute name, with all links followed, so that different names of one file
/// are equal. Errors: the InputError of writeFile.
std::filesystem::path outputFile(const std::filesystem::path& path);

/// Throws the InputError that writeFile would throw, before hours of work: makes the temporary file and removes it.
void checkWritable(const std::filesystem::path& path);

}  // namespace lumulus
