#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumulus::cli {

struct CompositeOptions {
    std::filesystem::path color;                 ///< .exr with R, G, B, in any of its parts and layers
    std::filesystem::path depth;                 ///< .exr with Z or depth.Z; empty: the colour's file
    std::string layer;                           ///< of the colour, see findColour; empty: the picture itself
    std::filesystem::path scene;                 ///< camera and fog
    std::vector<std::filesystem::path> outputs;  ///< .exr (linear) and .png (tone mapped)
    std::vector<std::string> overrides;
    std::optional<std::int64_t> frame;  ///< of an animated scene
    std::string device;
    std::string stats;  ///< file, "-" for stdout, empty for none
    bool validate = false;
};

/// Runs `lumulus composite`: shows a picture of any renderer through the fog of a scene, unchanged without fog media.
/// An EXR file keeps the windows of the picture; the scene's field of view is that of its display window.
/// Errors: InputError before any work for bad usage, scenes, pictures and places that cannot be written to.
void runComposite(const CompositeOptions& options);

}  // namespace lumulus::cli
