#pragma once

#include "scene/scene.h"

namespace lumulus::scene {

enum class Quality { draft, interactive, final };

/// Photons, generations and bands of a preset: draft 200 000 / 10 / 3, interactive 1 M / 20 / 4, final 8 M / 40 / 6.
/// loadScene applies it below the file, so that what a scene says explicitly stays.
void applyQuality(Scene& scene, Quality quality);

}  // namespace lumulus::scene
