#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumulus::cli {

struct FetchOptions {
    std::string address = "127.0.0.1:7788";
    std::filesystem::path tokenFile;
    std::filesystem::path output;
    std::string scene;          ///< a name on the server, or an existing local file that ends with .toml
    std::filesystem::path vdb;  ///< file to upload instead of the scene's cloud
    std::vector<std::string> overrides;
    std::string quality;
    std::optional<int> width, height;
    std::vector<double> position, target;  ///< three numbers, or none
    std::optional<double> verticalFov;
    std::vector<double> sun;  ///< azimuth and elevation, or none
    std::optional<double> milliseconds;
    std::optional<std::uint64_t> photons;
    std::optional<double> exposure;
    std::string stats;  ///< file for the reply's JSON, "-" for stdout, empty for none
    double timeout = 300.0;
};

/// Runs `lumulus fetch`: writes one frame of a running service to a file. Errors: InputError for bad usage and for
/// requests that the server refuses as wrong; Error if the connection fails.
void runFetch(const FetchOptions& options);

}  // namespace lumulus::cli
