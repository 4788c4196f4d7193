#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/settings.h"

namespace lumulus::scene {

/// True if the file lies in one of the folders, with links followed, or if no folders are given.
bool isAllowed(const std::filesystem::path& file, std::span<const std::filesystem::path> folders);

/// Refuses a file of the key `path` that does not exist, may not be read, or lies in none of the `allowed` folders
/// where there are any. `kind`: "an OpenVDB file". Errors: InputError.
void checkFile(const std::filesystem::path& file, const std::string& path, const char* kind,
               std::span<const std::filesystem::path> allowed, const Settings& settings);

}  // namespace lumulus::scene
