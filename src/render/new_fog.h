#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/interrupt.h"
#include "scene/fog.h"

namespace lumulus {

/// Media of fog, with the light of sun and sky in them (world_fog.h). Immutable; for any renderer of the same scene.
struct NewFog;

/// Finds the light of other media, which takes up to a second, in the sun and the sky of the moment at which it was
/// asked for: on any thread, beside the renderer, which may be gone. `check` is asked between the steps; what it throws
/// ends them. Errors: InputError for media that cannot take the place of those that there are.
using FogMaker = std::function<std::shared_ptr<const NewFog>(std::vector<scene::FogMedium>, const Check& check)>;

}  // namespace lumulus
