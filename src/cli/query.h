#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/quality.h"

namespace lumulus::cli {

struct QueryOptions {
    std::filesystem::path scene;
    std::filesystem::path segments;  ///< table of segments; empty: not asked for
    std::filesystem::path sun;       ///< table of points; empty: not asked for
    std::filesystem::path ambient;   ///< table of points; empty: not asked for
    std::vector<double> rectangle;   ///< x0, z0, x1, z1 [m]; empty: not asked for
    std::string size = "512x512";    ///< of the rectangle, pixels
    std::optional<double> height;    ///< of the rectangle [m]; absent: that of the ground
    std::filesystem::path output;    ///< empty: stdout
    std::vector<std::string> overrides;
    std::optional<scene::Quality> quality;  ///< of the photons, for ambient light
    std::optional<std::int64_t> frame;      ///< of an animated scene
    std::string device;
    bool json = false;
    bool quiet = false;
};

/// Runs `lumulus query` (docs/query.md). Errors: InputError for bad usage, scenes and tables, with file and line, and
/// for places that cannot be written to, before any work.
void runQuery(const QueryOptions& options);

}  // namespace lumulus::cli
