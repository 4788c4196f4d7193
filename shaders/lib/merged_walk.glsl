// The walk through several clouds at once: one grid of cells in the world, each with the sum of the majorants of the clouds
// in it and a list of them. Cells lie in bricks; bricks without any are crossed at once, and empty cells of others together.
#ifndef LUMULUS_LIB_MERGED_WALK
#define LUMULUS_LIB_MERGED_WALK

#include "shared/world.h"
#include "lib/traversal.glsl"

layout(binding = 11, r32ui) uniform readonly uimageBuffer bricks;
layout(binding = 12, rg32ui) uniform readonly uimageBuffer mergedCells;  // majorant [1/m] or distance to one; list
layout(binding = 13, r32ui) uniform readonly uimageBuffer lists;

struct MergedCell {
    float majorant;  // [1/m]
    uint list;
    vec3 below, above;  // cells on each side that are as empty
};

MergedCell mergedCellAt(ivec3 extent, ivec3 cell) {
    const ivec3 brick = cell / MERGED_BRICK, within = cell % MERGED_BRICK;
    const uint found = imageLoad(bricks, (brick.z * extent.y + brick.y) * extent.x + brick.x).r;
    if (found >= EMPTY_BRICK) {
        const float beyond = float(MERGED_BRICK) * (float(found - EMPTY_BRICK) - 1.0);
        return MergedCell(0.0, 0u, vec3(within) + beyond, vec3(MERGED_BRICK - 1 - within) + beyond);
    }
    const int place = (within.z * MERGED_BRICK + within.y) * MERGED_BRICK + within.x;
    const uvec2 texel = imageLoad(mergedCells, int(found) * MERGED_BRICK_CELLS + place).rg;
    const float majorant = uintBitsToFloat(texel.x);
    const vec3 reach = vec3(emptyReach(majorant));
    return MergedCell(max(majorant, 0.0), texel.y, reach, reach);
}

uint countInList(uint list) { return list >= SINGLE_INSTANCE ? 1u : imageLoad(lists, int(list)).r; }

uint instanceInList(uint list, uint place) {
    return list >= SINGLE_INSTANCE ? list - SINGLE_INSTANCE : imageLoad(lists, int(list + 1u + place)).r;
}

#endif
