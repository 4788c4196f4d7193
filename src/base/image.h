#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace lumulus {

/// A picture as named float layers ("R", "depth.Z", …), each width × height, rows from the top.
struct LayeredImage {
    int width = 0;
    int height = 0;
    std::map<std::string, std::vector<float>> layers;
    std::map<std::string, std::string> attributes;  ///< header attributes (text) of an EXR file

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

    /// Returns the named layer. A layer that does not exist yet is created with all values equal to `fill`.
    std::vector<float>& layer(const std::string& name, float fill = 0.0F) {
        return layers.try_emplace(name, pixels(), fill).first->second;
    }
};

}  // namespace lumulus
