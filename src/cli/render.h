#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/light_maps.h"
#include "cli/render_error.h"
#include "scene/quality.h"

namespace lumulus::cli {

struct RenderOptions {
    std::filesystem::path scene;
    std::vector<std::filesystem::path> outputs;  ///< .exr (linear) and .png (tone mapped)
    std::optional<scene::Quality> quality;
    std::vector<std::string> overrides;
    std::optional<std::uint64_t> seed;
    std::optional<double> seconds;      ///< time of the whole run, instead of the scene's number of photons
    std::optional<double> targetError;  ///< relMSE of the photons' noise to stop at
    std::string frames;                 ///< "A-B:STEP"; empty: one picture
    bool skipExisting = false;          ///< frames whose files are whole
    LightMapOptions maps;
    ErrorOptions error;
    std::string device;
    std::string stats;  ///< file, "-" for stdout, empty for none
    bool quiet = false;
    bool validate = false;
};

/// Runs `lumulus render`. Errors: InputError before any work for bad usage, bad scenes and unwritable places.
void runRender(const RenderOptions& options);

}  // namespace lumulus::cli
