#pragma once

#include "scene/schema.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Sets the directions of sun and moon by their angles, or by time and place where the scene has a time. Errors:
/// InputError with the key and its line.
void finishSunAndMoon(Draft& draft, const Settings& settings);

/// Scales the irradiance that an atmosphere gives the sun by default to the date's distance. After finishSky.
void finishSunDistance(Draft& draft, const Settings& settings);

}  // namespace lumulus::scene
