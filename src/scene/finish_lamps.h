#pragma once

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Directions from targets, power from lumens and temperature. Errors: InputError for keys that a kind does not have,
/// for a lamp without light or without a direction, and for one around the camera's eye.
void finishLamps(Draft& draft, const Settings& settings);

/// Refuses a lamp around the eye. Errors: InputError.
void requireEyeOutsideLamps(const Scene& scene, const glm::dvec3& eye);

}  // namespace lumulus::scene
