#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/exr.h"

namespace lumulus::cli {

/// Where the colours of a picture stand in an EXR file.
struct ColourChannels {
    std::size_t part = 0;
    std::string layer;                 ///< "" for R, G, B; "ViewLayer.Combined" for ViewLayer.Combined.R
    std::array<std::string, 3> names;  ///< of red, green and blue
    std::optional<std::string> alpha;
};

/// Where the depth of a picture stands in an EXR file.
struct DepthChannel {
    std::size_t part = 0;
    std::string name;
};

/// Finds the colours of a file: R, G, B, or those of a layer. `wanted` is a layer's whole name, its end or its
/// beginning
/// ("ViewLayer.Combined", "Combined", "ViewLayer") or the name of a part; where it is empty, plain R, G, B come first,
/// then a layer called Combined, beauty, rgba, rgb or color, then the only one there is. All parts are searched.
/// Errors: InputError where no layer fits, or several.
ColourChannels findColour(const std::vector<ExrPart>& parts, const std::string& wanted,
                          const std::filesystem::path& path);

/// Finds the depth of a file: Z, depth.Z, or the Z (or V) of a layer whose last word is z or has "depth" in it
/// ("ViewLayer.Depth.Z"). Of several, the one that shares the beginning of its name with `layer`.
/// Errors: InputError where none fits, or several.
DepthChannel findDepth(const std::vector<ExrPart>& parts, const std::string& layer, const std::filesystem::path& path);

}  // namespace lumulus::cli
