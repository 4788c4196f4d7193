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

/// `lumulus cloud`: a procedural cloud as an OpenVDB file. Errors: InputError for an unknown kind or a bad place, Error
/// where interrupted.
void runCloud(const CloudOptions& options);

}  // namespace lumulus::cli
