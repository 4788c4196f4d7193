#pragma once

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Fills in what the sky's model and preset imply, and refuses keys that the model does not read. Errors: InputError.
void finishSky(Draft& draft, const Settings& settings);

}  // namespace lumulus::scene
