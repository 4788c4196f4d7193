#pragma once

#include <filesystem>
#include <span>

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Finishes a scene: checks keys that depend on each other (alternatives, the camera's axes, the number of pixels,
/// files that must exist, parameters without effect) and computes the sun's direction. Errors: InputError.
Scene finishScene(Draft draft, const Settings& settings);

}  // namespace lumulus::scene
