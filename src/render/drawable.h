#pragma once

#include "scene/scene.h"

namespace lumulus {

/// The scene, if all that is in it can be drawn. Errors: InputError.
const scene::Scene& drawable(const scene::Scene& scene);

}  // namespace lumulus
