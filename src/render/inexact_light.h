#pragma once

#include "render/world.h"
#include "scene/scene.h"

/// Which light photon maps do not get right (inside render/ only). Each function adds a warning to the report and marks
/// the clouds.
namespace lumulus {

/// Light that goes to and fro along its line is not exact everywhere (docs/experiments/backward-peak.md).
void warnOfBackwardPeaks(const scene::Scene& scene, WorldReport& report);

/// Neither is light at the surface of clouds that it enters by less than half a voxel (docs/stability.md); and that of
/// clouds with flat voxels is off by one or two per cent (docs/experiments/flat-voxels.md), of which nobody is warned.
void warnOfUnresolvedVoxels(const World& world, WorldReport& report);

}  // namespace lumulus
