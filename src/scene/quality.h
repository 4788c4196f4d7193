#pragma once

#include "scene/scene.h"

namespace lumulus::scene {

enum class Quality { draft, interactive, final };

/// Photons, generations, bands and, for `final`, the cut of a preset (docs/error-time.md has what they were chosen by).
/// loadScene applies it below the file, so that what a scene says explicitly stays.
void applyQuality(Scene& scene, Quality quality);

}  // namespace lumulus::scene
