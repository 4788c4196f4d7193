#pragma once

#include "scene/fog.h"
#include "view/camera.h"

namespace lumulus::fog {

/// Pixels across a radian in the middle of the picture, taken for all of it: a picture of one distance has one spread,
/// and light of the same everywhere stays so. For an orthographic camera pixels across a metre.
double pixelsPerRadian(const Camera& camera);

/// A bound of the spread [pixels] of light from `farthest` metres away and nearer, in any direction that the camera
/// sees.
double largestSpread(const scene::Fog& fog, const Camera& camera, double farthest);

}  // namespace lumulus::fog
