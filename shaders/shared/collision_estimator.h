// What photons count in cells: the luminance of scattering events in each, and in cubes of FLUX_EDGE cells its vector,
// the sum of luminance times direction. int64 each. A cube's cells and its vector lie together, and the cubes of a
// block too: what a photon meets next is near, in the cache and in the page.
#ifndef LUMULUS_SHARED_COLLISION_ESTIMATOR_H
#define LUMULUS_SHARED_COLLISION_ESTIMATOR_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Cells along the edge of a cube. Directions are noisier than amounts and change more slowly in space
/// (docs/experiments/light-field-direction.md).
const int FLUX_EDGE = 2;
const int CUBE_CELLS = FLUX_EDGE * FLUX_EDGE * FLUX_EDGE;
/// int64 of a cube: its cells, then the vector.
const int CUBE_COUNTS = CUBE_CELLS + 3;
/// Cubes along the edge of a block.
const int BLOCK_CUBES = 4;

SHARED_FN uvec3 estimatorBlocks(ivec3 cells) {
    const uint edge = uint(FLUX_EDGE * BLOCK_CUBES);
    return (uvec3(cells) + (edge - 1U)) / edge;
}

SHARED_FN uint numberIn(uvec3 extent, uvec3 place) {
    return (place.z * extent.y + place.y) * extent.x + place.x;
}

/// Where the counts of a cell's cube begin.
SHARED_FN uint cubePlace(ivec3 cells, ivec3 cell) {
    const uint edge = uint(BLOCK_CUBES);
    const uvec3 cube = uvec3(cell) / uint(FLUX_EDGE);
    const uint number =
        numberIn(estimatorBlocks(cells), cube / edge) * (edge * edge * edge) + numberIn(uvec3(edge), cube % edge);
    return number * uint(CUBE_COUNTS);
}

/// Of its cell, counted from cubePlace().
SHARED_FN uint placeInCube(ivec3 cell) {
    return numberIn(uvec3(uint(FLUX_EDGE)), uvec3(cell) % uint(FLUX_EDGE));
}

/// int64 of all blocks.
SHARED_FN uint estimatorCounts(ivec3 cells) {
    const uvec3 blocks = estimatorBlocks(cells);
    return blocks.x * blocks.y * blocks.z * uint(BLOCK_CUBES * BLOCK_CUBES * BLOCK_CUBES * CUBE_COUNTS);
}

SHARED_END

#endif
