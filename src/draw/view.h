#pragma once

#include "draw/camera.h"
#include "phase/scattering_tables.h"
#include "scene/scene.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// Edge of a pixel at a place of the world [m].
double pixelLength(const Camera& camera, const glm::dvec3& place);

/// Rays along each side of a pixel, 1 to 4: about one a voxel, which has the edge of so many pixels.
int raysAcross(double voxelPixels);

/// The camera for the GPU; positions there are relative to the eye.
shared::ViewParams viewParams(const Camera& camera);

/// Lights and medium for the drawing passes.
shared::LightParams lightParams(const scene::Sun& sun, const scene::Sky& sky, const glm::dvec3& albedo,
                                const phase::ScatteringTables& tables);

}  // namespace lumulus::draw
