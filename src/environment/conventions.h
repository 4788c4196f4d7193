#pragma once

#include <map>
#include <string>

#include "environment/environment_files.h"

namespace lumulus::environment {

/// What a program needs to know to use the files.
struct Conventions {
    std::string json;
    std::map<std::string, std::string> attributes;  ///< of EXR files
};

Conventions conventionsOf(const Surroundings& surroundings, const scene::Scene& scene, const FileOptions& options);

/// What the table of the BRDF holds.
std::string brdfText(Method method);

}  // namespace lumulus::environment
