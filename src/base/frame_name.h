#pragma once

#include <cstdint>
#include <filesystem>

/// Names of files that have the number of a frame in them.
namespace lumulus {

/// Whether a name has a place for the number of a frame: "####" or "%04d".
bool hasFrameNumber(const std::filesystem::path& name);

/// The name of a frame's file: "cloud_####.exr" → "cloud_0007.exr". The last place counts. A number that needs more
/// digits has them.
std::filesystem::path nameOfFrame(const std::filesystem::path& name, std::int64_t frame);

}  // namespace lumulus
