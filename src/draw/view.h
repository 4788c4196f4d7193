#pragma once

#include "draw/camera.h"
#include "phase/scattering_tables.h"
#include "scene/scene.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// Rays along each side of a pixel, 1 to 4: about one a voxel (edge `voxelLength` [m]) at the cloud's `centre`.
int raysAcross(const Camera& camera, const glm::dvec3& centre, double voxelLength);

/// The camera for the GPU; positions there are relative to the eye.
shared::ViewParams viewParams(const Camera& camera);

/// Lights and medium for the drawing passes.
shared::LightParams lightParams(const scene::Sun& sun, const scene::Sky& sky, const glm::dvec3& albedo,
                                const phase::ScatteringTables& tables);

}  // namespace lumulus::draw
