#pragma once

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Checks the names and files of meshes. Errors: InputError.
void finishMeshes(const Draft& draft, const Settings& settings);

}  // namespace lumulus::scene
