#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumulus::cli {

struct SkyOptions {
    std::optional<std::filesystem::path> scene;  ///< absent: a scene of defaults
    std::vector<std::string> overrides;
    std::optional<std::int64_t> frame;  ///< of an animated scene
    bool json = false;
};

/// Runs `lumulus sky`: prints where sun and moon stand and what light they and the sky give at the camera, or 2 m above
/// the ground where the scene has no position of a camera. Errors: those of loadScene.
void runSky(const SkyOptions& options);

}  // namespace lumulus::cli
