#pragma once

#include <filesystem>

namespace lumulus::job {

/// Whether a file is a picture (.exr, .png) that has been written to its end.
bool isWholePicture(const std::filesystem::path& path);

}  // namespace lumulus::job
