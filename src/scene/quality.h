#pragma once

#include "scene/scene.h"

namespace lumulus::scene {

enum class Quality { draft, interactive, final };

/// Sets photons, generations, bands and, for `final`, the forward cut of a preset
/// (docs/experiments/light-field-direction.md). loadScene applies it before the file, so that the file's keys win.
void applyQuality(Scene& scene, Quality quality);

}  // namespace lumulus::scene
