#pragma once

#include <glm/glm.hpp>

/// Voxels that are no cubes, by their edges in metres (columns).
namespace lumulus::cloud {

/// Whether edges differ by more than a tenth.
bool hasFlatVoxels(const glm::dmat3& edges);

/// [m]
double shortestEdge(const glm::dmat3& edges);

/// The width of a voxel that is seen in a direction, across which it is smallest [m].
double smallestWidth(const glm::dmat3& edges, const glm::dvec3& direction);

}  // namespace lumulus::cloud
