// Light that comes up from the ground below the clouds, or down from the sky.
#ifndef LUMULUS_LIB_GROUND_LIGHT
#define LUMULUS_LIB_GROUND_LIGHT

#include "shared/ground.h"

layout(binding = 20, scalar) readonly buffer GroundLight { GroundParams ground; vec3 groundRadiance[]; };

/// Of a place of the walk [cells]: metres from the corner of the grids on the ground along x and z, and above the ground.
vec3 overGround(vec3 place) { return ground.cellsToWorld * place + ground.origin; }

/// The cell of a grid over the ground in which a place is; −1 where none is.
int groundCell(vec2 place, ivec2 cells) {
    const vec2 cell = floor(place / ground.extent * vec2(cells));
    if (any(lessThan(cell, vec2(0.0))) || any(greaterThanEqual(cell, vec2(cells)))) return -1;
    return int(cell.y) * cells.x + int(cell.x);
}

/// Light that comes from a direction to a place of the walk, over what photons of the sky stand for: of the ground without the
/// light of clouds, or of the sky.
vec3 skyOrGround(vec3 place, vec3 direction) {
    if (direction.y <= 0.0) return ground.sky;
    const vec3 above = overGround(place);
    const vec2 hit = above.xz - direction.xz * (above.y / direction.y);
    const int cell = groundCell(hit, ground.cells);
    return cell < 0 ? ground.open : groundRadiance[cell];
}

#endif
