// What photons count in cells: the luminance that turns in each, and in cubes of FLUX_EDGE cells its vector, the sum of
// luminance times direction. int64 each: [cell], then [cube][x, y, z].
#ifndef LUMULUS_SHARED_DEPOSITS_H
#define LUMULUS_SHARED_DEPOSITS_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Directions are noisier than amounts and change more slowly in space (docs/error-time.md).
const int FLUX_EDGE = 2;

SHARED_FN ivec3 fluxCubes(ivec3 cells) {
    return (cells + (FLUX_EDGE - 1)) / FLUX_EDGE;
}

SHARED_FN uint numberIn(ivec3 cells, ivec3 cell) {
    return uint((cell.z * cells.y + cell.y) * cells.x + cell.x);
}

SHARED_FN uint cellsIn(ivec3 cells) {
    return uint(cells.x) * uint(cells.y) * uint(cells.z);
}

/// Place of a cube's first component.
SHARED_FN uint fluxPlace(ivec3 cells, ivec3 cell) {
    return cellsIn(cells) + 3U * numberIn(fluxCubes(cells), cell / FLUX_EDGE);
}

/// int64 of all cells and cubes.
SHARED_FN uint depositCounts(ivec3 cells) {
    return cellsIn(cells) + 3U * cellsIn(fluxCubes(cells));
}

SHARED_END

#endif
