#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/quality.h"

namespace lumulus::cli {

struct BakeOptions {
    std::filesystem::path scene;
    std::filesystem::path output;  ///< .vdb; its conventions stand beside it as .json
    bool nano = false;             ///< whether a .nvdb is written too
    std::optional<double> voxel;   ///< edge [m]
    std::optional<scene::Quality> quality;
    std::vector<std::string> overrides;
    std::optional<std::int64_t> frame;  ///< of an animated scene
    std::optional<std::uint64_t> seed;  ///< absent: photon_map.seed
    std::string device;
    bool quiet = false;
};

/// Runs `lumulus bake`: writes the light in a scene's clouds as grids. Errors: InputError for bad usage and bad scenes.
void runBake(const BakeOptions& options);

}  // namespace lumulus::cli
