#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "vdb/placed_volume.h"

namespace lumulus {

/// Where a cloud, or several of them, are: a box, rotated and sheared as its grid is. Metres.
struct Bounds {
    glm::dvec3 centre{0.0};
    glm::dmat3 halfAxes{500.0};       ///< columns: from the centre to the middles of three faces
    std::vector<glm::dvec3> outline;  ///< points whose convex hull holds the cloud more tightly; may be empty

    double radius() const;  ///< of the sphere around the eight corners
    std::array<glm::dvec3, 8> corners() const;
};

/// The box of the voxels that are not zero; of all voxels where all are.
Bounds boundsOf(const vdb::PlacedVolume& cloud);

/// What holds all of `parts`: for several of them a box along the world's axes around all their corners, with the
/// outlines of all; for one of them that one; for none the default.
Bounds unite(std::span<const Bounds> parts);

/// The bounds of all clouds together.
Bounds boundsOf(std::span<const vdb::PlacedVolume> clouds);

}  // namespace lumulus
