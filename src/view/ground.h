#pragma once

#include "scene/scene.h"
#include "view/bounds.h"

namespace lumulus {

/// The scene with its ground. A file that names neither a sky nor a ground has an atmosphere whose planet lies at y = 0
/// or, where that is too near to the clouds or more than 20 km away from them, below them: three radii of all clouds,
/// at least 600 m and at most 2000 m, and as far below a camera that stands lower than they do. Its centre is below
/// theirs, however far from the origin they are. It ends level fog. Other scenes stay as they are.
scene::Scene groundedScene(const scene::Scene& scene, const Bounds& clouds);

}  // namespace lumulus
