#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lumulus::cli {

struct CloudOptions {
    std::string kind;
    std::filesystem::path output;  ///< .vdb
    int resolution = 128;          ///< voxels along the longest side
    std::uint64_t seed = 1;
    std::string frames;        ///< "A-B:STEP" of a cloud that moves; empty: one file
    double fps = 24.0;         ///< frames a second
    std::vector<double> wind;  ///< three numbers [m/s], or none
    double swirl = 0.0;        ///< m/s
    bool quiet = false;
};

/// Runs `lumulus cloud`: writes a procedural cloud as an OpenVDB file, or one that moves as a file a frame. Errors:
/// InputError for an unknown kind or a place that cannot be written to, Error if interrupted.
void runCloud(const CloudOptions& options);

}  // namespace lumulus::cli
