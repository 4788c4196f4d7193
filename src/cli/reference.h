#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumulus::cli {

struct ReferenceOptions {
    std::filesystem::path scene;
    std::filesystem::path output;
    std::optional<std::uint64_t> spp;  ///< samples per pixel in all, earlier runs included
    std::optional<double> seconds;     ///< of this run; at least one sample per pixel
    bool localMajorant = false;
    bool resume = false;
    std::vector<std::string> overrides;
    std::optional<std::uint64_t> seed;  ///< absent: photon_map.seed
    bool quiet = false;
};

/// `lumulus reference`: renders without bias and writes the picture, with the exact sums beside it (`.sums`), from
/// which a later run goes on. Errors: InputError for bad input, Error where nothing could be finished.
void runReference(const ReferenceOptions& options);

}  // namespace lumulus::cli
