#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "draw/camera.h"
#include "scene/fog.h"
#include "shared/fog.h"

/// The media of a scene for the maths of shaders/shared/fog.h.
namespace lumulus::fog {

/// The media as they lie around `eye` [m]. Differences of large coordinates are taken in double.
std::vector<shared::FogMedium> mediaAround(const scene::Fog& fog, const glm::dvec3& eye);

/// Share of sunlight, by channel, that reaches `point` straight through the fog. Media without an end stop at
/// `skyDistance`.
glm::dvec3 sunTransmittance(const scene::Fog& fog, const glm::dvec3& point, const glm::dvec3& directionTo);

/// Pixels across a radian in the middle of the picture, taken for all of it: a picture of one distance has one spread,
/// and light of the same everywhere stays so. For an orthographic camera pixels across a metre.
double pixelsPerRadian(const Camera& camera);

/// A bound of the spread [pixels] of light from `farthest` metres away and nearer, in any direction that the camera
/// sees.
double largestSpread(const scene::Fog& fog, const Camera& camera, double farthest);

}  // namespace lumulus::fog
