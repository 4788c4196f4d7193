#pragma once

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// The finished scene: what several keys say together, checked (alternatives, the camera's axes, the number of pixels,
/// files that must exist, parameters that nothing reads) and the sun's direction worked out. Errors: InputError.
Scene finishScene(Draft draft, const Settings& settings);

}  // namespace lumulus::scene
