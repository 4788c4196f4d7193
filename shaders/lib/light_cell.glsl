// Cells of the light field beside each other: what light_cells.comp writes and light_smooth.comp reads.
#ifndef LUMULUS_LIB_LIGHT_CELL
#define LUMULUS_LIB_LIGHT_CELL

/// Empty cells around the grid, so that smoothing looks beyond its faces without asking.
const int CELL_RINGS = 2;

/// A place in a cell, from its lower corner [cells], in the bits of a number between ½ and 2.
float packedPlace(vec3 place) {
    const uvec3 steps = uvec3(round(255.0 * place));
    return uintBitsToFloat(0x3F000000u | (steps.x << 16) | (steps.y << 8) | steps.z);
}

vec3 unpackedPlace(float packed) {
    const uint bits = floatBitsToUint(packed);
    return vec3((bits >> 16) & 255u, (bits >> 8) & 255u, bits & 255u) * (1.0 / 255.0);
}

/// Weight of the cell that lies `by` cells away: (¼, ½, ¼) along each axis, or as far as two cells, times a constant.
float cellWeight(ivec3 by, int reach) {
    const ivec3 weight = reach + 1 - abs(by);
    return float(weight.x * weight.y * weight.z);
}

#endif
