#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/quality.h"

namespace lumulus::cli {

struct EnvironmentOptions {
    std::filesystem::path scene;
    std::filesystem::path output;  ///< .exr; names of the other files are made of it
    std::vector<double> at;        ///< x, y, z [m]; empty: where `lumulus sky` looks from
    std::optional<int> levels;
    std::vector<double> roughness;  ///< of the levels; empty: equal steps
    std::optional<int> size;        ///< pixels along an edge of the finest faces
    std::string method = "sampling";
    bool byLevel = false, byFace = false;
    bool withSun = false;  ///< whether discs are in the map
    std::optional<scene::Quality> quality;
    std::vector<std::string> overrides;
    std::optional<std::int64_t> frame;  ///< of an animated scene
    std::optional<std::uint64_t> seed;  ///< absent: photon_map.seed
    std::optional<double> seconds;      ///< of the whole run, instead of the scene's number of photons
    std::string device;
    bool quiet = false;
};

/// Runs `lumulus environment`: writes a scene's light around a point as maps for other programs. Errors: InputError for
/// bad usage, bad scenes and places that cannot be written to.
void runEnvironment(const EnvironmentOptions& options);

}  // namespace lumulus::cli
