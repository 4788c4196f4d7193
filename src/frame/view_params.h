#pragma once

#include "shared/draw.h"
#include "view/camera.h"

namespace lumulus::frame {

/// Edge of a pixel at a place of the world [m].
double pixelLength(const Camera& camera, const glm::dvec3& place);

/// Rays along each side of a pixel, 1 to 4: about one a voxel, which has the edge of so many pixels.
int raysAcross(double voxelPixels);

/// The camera for the GPU; positions there are relative to the eye.
shared::ViewParams viewParams(const Camera& camera);

}  // namespace lumulus::frame
