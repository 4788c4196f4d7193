#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumulus::cli {

struct BenchOptions {
    std::filesystem::path scene;
    std::filesystem::path reference;  ///< .exr of the scene's size
    std::filesystem::path output;     ///< folder for error.csv, error.svg and error.png; created if missing
    std::vector<double> seconds{0.1, 0.3, 1.0, 3.0, 10.0};
    int seeds = 3;
    std::vector<std::string> overrides;
    std::optional<std::int64_t> frame;  ///< of an animated scene
    std::string device;
    std::filesystem::path cycles;  ///< table of another renderer's points; empty: none
    bool quiet = false;
};

/// Runs `lumulus bench`: error against run time of `render` and of the path tracer. Errors: InputError before any work
/// for bad usage and for scenes and references that do not fit; Error if interrupted (nothing is written then).
void runBench(const BenchOptions& options);

}  // namespace lumulus::cli
