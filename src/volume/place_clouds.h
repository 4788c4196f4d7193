#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace lumulus {

/// Instances that the memory budget of a scene's light has room for: each has 30 collectors at least.
std::size_t mostInstances(const scene::Scene& scene);

/// The scene with a cloud for each row of `instances` and each cloud of a field, in their order: NAME[0], NAME[1] and
/// so on, with places of their own. Clouds of one source still share one asset. A scene without such stays as it is,
/// and a scene that was placed stays so. Renderer and reference both need placed scenes. Errors: InputError for a bad
/// file of places and for more instances than there is room for.
scene::Scene placeClouds(scene::Scene scene);

}  // namespace lumulus
