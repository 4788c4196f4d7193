#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "environment/levels.h"
#include "environment/surroundings.h"

namespace lumulus::environment {

struct FileOptions {
    std::filesystem::path output;  ///< the cube map; names of the others are made of it
    Method method = Method::sampling;
    std::vector<Level> levels;
    bool byLevel = false;  ///< whether each level is a latitude-longitude file, too
    bool byFace = false;   ///< whether each face of each level is a file, too
};

/// A file and what is in it.
struct File {
    std::filesystem::path path;
    std::vector<std::byte> bytes;
};

/// Names of all files: the cube map (env.exr), its conventions (env.json), the panorama (env_latlong.exr), the table of
/// the BRDF (env_brdf.exr), with `byLevel` env_m0.exr and so on, with `byFace` env_m0_px.exr and so on.
std::vector<std::filesystem::path> namesOf(const FileOptions& options);

/// Filters the surroundings, and encodes all files, in the order of namesOf(). Errors: what `check` throws.
std::vector<File> filesOf(const Surroundings& surroundings, const scene::Scene& scene, const FileOptions& options,
                          const Report& report, const Check& check);

}  // namespace lumulus::environment
