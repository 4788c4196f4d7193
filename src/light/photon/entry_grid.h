#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "light/photon/entry_discs.h"

namespace lumulus::photon {

/// A coarse grid of the world with lists of the ellipsoids in each cell, so that a photon that begins asks only those
/// near its line.
struct EntryGrid {
    glm::ivec3 cells{1};
    double edge = 1.0;  ///< of a cell [m]
    /// Where each cell's list begins, x fastest, and the end; then the numbers in the lists.
    std::vector<std::uint32_t> lists;
};

/// Over the box from `lower` to `upper`, which holds all ellipsoids. Cells are about as large as the ellipsoids, and no
/// more than a few dozen for each.
EntryGrid makeEntryGrid(std::span<const PlacedEllipsoid> ellipsoids, const glm::dvec3& lower, const glm::dvec3& upper);

}  // namespace lumulus::photon
