// Interface structs of the ground: how photons meet it.
#ifndef LUMULUS_SHARED_GROUND_H
#define LUMULUS_SHARED_GROUND_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Cells along each side of the grid in which photons that fall on the ground are counted.
const int GROUND_COUNTS = 48;

/// The ground as a walk knows it; behind it lie the radiances of `cells`, x fastest. Radiances are over the one that
/// photons of the sky stand for.
struct GroundParams {
    mat3 cellsToWorld;  // of the walk's cells [m]
    vec3 origin;  // of the corner of the walk's cells: from the corner of the grids along x and z, above the ground
    vec2 extent;  // of the grids along x and z [m]
    ivec2 cells;  // of the grid of radiances
    vec3 albedo;
    vec3 open;       // radiance outside of the grid
    vec3 sky;        // of the sky
    uint countBase;  // where the counts begin among all counts
};

/// Reads the counts.
struct GroundCountsPush {
    uint base;
    uint count;
    float unit;  // W
};

#ifdef __cplusplus
static_assert(sizeof(GroundParams) == 104 && offsetof(GroundParams, countBase) == 100);
static_assert(sizeof(GroundCountsPush) == 12 && offsetof(GroundCountsPush, unit) == 8);
#endif

SHARED_END

#endif
