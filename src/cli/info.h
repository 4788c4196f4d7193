#pragma once

#include <filesystem>

namespace lumulus::cli {

struct InfoOptions {
    std::filesystem::path file;  ///< an OpenVDB file
    bool devices = false;
    bool sceneFormat = false;  ///< print docs/scene-format.md
    bool json = false;
};

/// Runs `lumulus info`: prints the grids of a file, or the devices. Errors: InputError for an unreadable file.
void runInfo(const InfoOptions& options);

}  // namespace lumulus::cli
