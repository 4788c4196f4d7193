#pragma once

#include "fuzz/promise.h"
#include "scene/load.h"

namespace lumulus::test {

/// Reads a text as a scene file. Throws std::logic_error where what is read has values that the format does not allow.
inline void feed(std::span<const std::byte> input) {
    const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
    try {
        const scene::Scene scene = scene::parseScene(text, "input.toml");
        promise(scene.image.width > 0 && scene.image.height > 0, "a picture has pixels");
        promise(scene.clouds.size() <= 256, "a scene has 256 clouds at most");
        for (const scene::Cloud& cloud : scene.clouds) promise(cloud.extinction >= 0.0, "extinction is not negative");
    } catch (const InputError& error) {
        promise(std::string(error.what()).size() > 10, "an error says something");
    }
}

}  // namespace lumulus::test
