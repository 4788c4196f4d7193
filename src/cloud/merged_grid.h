#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cloud/asset.h"

namespace lumulus::cloud {

/// A cloud as the merged grid sees it. Its asset has block majorants (PrepareOptions::keepBlocks).
struct MergedSource {
    const Asset* asset = nullptr;
    glm::dmat3 voxelToMetres{1.0};
    glm::dvec3 origin{0.0};   ///< corner of voxel (0,0,0) [m]
    double extinction = 0.0;  ///< collision coefficient at density 1 [1/m]
};

/// One grid of majorants over several clouds, aligned to the axes of the world: cells in bricks of MERGED_BRICK³, of
/// which only those with density exist. A cell's majorant is the sum of those of the clouds in it, and it has a list of
/// them.
struct MergedGrid {
    glm::dvec3 origin{0.0};              ///< lower corner [m]
    double edge = 1.0;                   ///< of a cell [m]
    glm::ivec3 bricks{1};                ///< along each axis
    std::vector<std::uint32_t> numbers;  ///< of each brick, x fastest; EMPTY_BRICK + distance where it has no cells
    std::vector<glm::uvec2> cells;       ///< of each brick that exists, x fastest: bits of the majorant, list
    std::vector<std::uint32_t> lists;    ///< count and numbers, for cells with more than one cloud

    std::uint64_t bytes() const { return 4 * (numbers.size() + 2 * cells.size() + lists.size()); }
};

/// Edge of the cells [m] for these clouds: six voxels of the finest, more where there would be too many cells or bricks
/// between `lower` and `upper`, or where the finest is a speck beside the others.
double mergedCellEdge(std::span<const MergedSource> clouds, const glm::dvec3& lower, const glm::dvec3& upper);

/// Errors: none; a grid over nothing has one empty brick.
MergedGrid mergeGrids(std::span<const MergedSource> clouds, const glm::dvec3& lower, const glm::dvec3& upper,
                      double edge);

}  // namespace lumulus::cloud
