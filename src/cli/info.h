#pragma once

#include <filesystem>

namespace lumulus::cli {

struct InfoOptions {
    std::filesystem::path file;  ///< an OpenVDB file
    bool devices = false;
    bool sceneFormat = false;  ///< docs/scene-format.md on stdout
    bool json = false;
};

/// `lumulus info`: grids of a file, or devices. Errors: InputError for a file that cannot be read.
void runInfo(const InfoOptions& options);

}  // namespace lumulus::cli
