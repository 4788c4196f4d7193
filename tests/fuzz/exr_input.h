#pragma once

#include "base/exr.h"
#include "fuzz/promise.h"

namespace lumulus::test {

/// Reads bytes as an EXR picture. Throws std::logic_error where its layers do not have its size.
inline void feed(std::span<const std::byte> input) {
    readOrRefuse(input, "input.exr", [](const std::filesystem::path& path) {
        const LayeredImage image = readExr(path);
        promise(image.width > 0 && image.height > 0 && !image.layers.empty(), "a picture has pixels");
        for (const auto& [name, values] : image.layers)
            promise(values.size() == image.pixels(), "a layer has the size of its picture");
    });
}

}  // namespace lumulus::test
