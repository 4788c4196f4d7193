#pragma once

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Checks the fog of the scene and finishes its media: directions get the length 1, aerosols their
/// coefficients, and the ground ends what lies below it. Errors: InputError.
void finishFog(Draft& draft, const Settings& settings);

}  // namespace lumulus::scene
