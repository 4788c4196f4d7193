#pragma once

#include <cstddef>

#include "scene/scene.h"
#include "scene/settings.h"

namespace lumulus::scene {

/// Checks the keys of a field that depend on each other: area, smallest and largest diameter, its name, and keys that
/// its kind does not have. Errors: InputError.
void checkField(const Scene& scene, std::size_t index, const Settings& settings);

}  // namespace lumulus::scene
