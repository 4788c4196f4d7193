#pragma once

#include <span>

#include "scene/fog.h"
#include "view/camera.h"

namespace lumulus::fog {

/// Converts what a depth file holds, pixel by pixel with rows from the top, into metres along the ray; in place. What
/// has no distance (infinity, no number, at or behind the far end of an endless z-buffer) becomes shared::FAR_DEPTH,
/// negative values 0. A z-buffer z between `near` (0) and `far` (1) lies at near·far / (far − z (far − near)) along the
/// view's axis. Returns how many values were negative or no number.
std::size_t depthToDistance(std::span<float> depth, const scene::Fog& fog, const Camera& camera);

}  // namespace lumulus::fog
