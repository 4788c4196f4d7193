#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace lumulus {

/// Writes a whole file so that its name never stands for half of it: a temporary beside it, fsync, rename.
/// A symbolic link is followed; what is no regular file (a device, a pipe) is written to directly.
/// Errors: InputError for a place that cannot be written to, Error where writing fails (disk full); the temporary is
/// gone in both cases and a file that existed before is as it was.
void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Throws the InputError that writeFile would throw, before hours of work: makes the temporary and removes it.
void checkWritable(const std::filesystem::path& path);

}  // namespace lumulus
