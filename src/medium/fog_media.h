#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/fog.h"
#include "shared/fog.h"

/// The media of a scene for the maths of shaders/shared/fog.h.
namespace lumulus::fog {

/// The media as they lie around `eye` [m]. Differences of large coordinates are taken in double.
std::vector<shared::FogMedium> mediaAround(const scene::Fog& fog, const glm::dvec3& eye);

/// Share of sunlight, by channel, that reaches `point` straight through the fog. Media without an end stop at
/// `skyDistance`.
glm::dvec3 sunTransmittance(const scene::Fog& fog, const glm::dvec3& point, const glm::dvec3& directionTo);

}  // namespace lumulus::fog
