#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "reference/film.h"
#include "scene/scene.h"

namespace lumulus::cli {

struct ReferenceOptions {
    std::filesystem::path scene;
    std::filesystem::path output;
    std::optional<std::uint64_t> spp;   ///< samples per pixel, earlier runs included
    std::optional<std::int64_t> frame;  ///< of an animated scene; its number goes into the name of the picture
    std::optional<double> seconds;      ///< time of this run; at least one sample per pixel
    bool localMajorant = false;
    std::optional<int> scatterings;  ///< light that was scattered or reflected more often is left out
    bool resume = false;
    std::vector<std::string> overrides;
    std::optional<std::uint64_t> seed;  ///< absent: photon_map.seed
    std::string stats;                  ///< file, "-" for stdout, empty for none
    bool quiet = false;
};

/// Runs `lumulus reference`: renders without bias and writes the picture, and beside it the exact sums (`.sums`), which
/// a later run can continue. Errors: InputError for bad input, Error if no pass was finished.
void runReference(const ReferenceOptions& options);

/// Notes in the header of a picture of the path tracer what made it.
void noteReference(LayeredImage& image, const scene::Scene& scene, const reference::Film& film, bool localMajorant);

}  // namespace lumulus::cli
