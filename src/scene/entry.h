#pragma once

#include <glm/glm.hpp>
#include <string>

#include "scene/settings.h"

namespace lumulus::scene {

/// An entry of an array whose kind decides which of its keys are read.
struct Entry {
    std::string path;  ///< "fog.media.0."
    std::string name;  ///< "medium"
    const Settings& settings;

    /// Refuses a key that the kind does not use, unless --set has replaced the file's kind.
    void checkRead(const char* key, bool read, const char* kinds) const;

    /// The place of a key, or its path where it has no value.
    std::string whereOf(const char* key) const;

    /// Normalises the direction of a key. Errors: InputError if it has no length.
    glm::dvec3 unitVector(const char* key, const glm::dvec3& direction) const;
};

}  // namespace lumulus::scene
