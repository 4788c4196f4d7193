#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load.h"

namespace lumulus::test {

/// What is wrong with a scene, or "no error".
inline std::string sceneMessage(const std::string& toml, const std::vector<std::string>& overrides = {}) {
    try {
        scene::parseScene(toml, "x.toml", overrides);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

}  // namespace lumulus::test
