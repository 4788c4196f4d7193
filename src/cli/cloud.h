#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lumulus::cli {

struct CloudOptions {
    std::string kind;
    std::filesystem::path output;  ///< .vdb
    int resolution = 128;          ///< voxels along the longest side
    std::uint64_t seed = 1;
    bool quiet = false;
};

/// Runs `lumulus cloud`: writes a procedural cloud as an OpenVDB file. Errors: InputError for an unknown kind or a
/// place that cannot be written to, Error if interrupted.
void runCloud(const CloudOptions& options);

}  // namespace lumulus::cli
