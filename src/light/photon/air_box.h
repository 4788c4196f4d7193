#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "light/photon/air_light.h"

/// What light in the box of a cloud needs, whatever it comes through.
namespace lumulus::photon {

/// Ends of a box along a direction of the world.
glm::dvec2 endsAlong(const Box& box, const glm::dvec3& direction);

/// A place from 0 to 1 along a direction: per voxel, and where voxel (0,0,0) lies.
glm::dvec4 placeAlong(const Box& box, const glm::dvec3& direction, const glm::dvec2& ends);

/// Vose's alias table of weights, which need no sum: `keep` and `other` of the cells.
void makeAlias(const std::vector<double>& weights, std::vector<shared::SkyCell>& cells);

/// Across the vertical, towards the sun.
glm::dvec3 acrossOf(const glm::dvec3& toSun, const glm::dvec3& up);

}  // namespace lumulus::photon
