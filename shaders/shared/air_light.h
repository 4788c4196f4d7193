// Light of an atmosphere in one cloud: where photons of the sky come from, and how the sun's light changes within it.
#ifndef LUMULUS_SHARED_AIR_LIGHT_H
#define LUMULUS_SHARED_AIR_LIGHT_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Places at which the sun's light in a cloud is known: along the sun's azimuth, by height.
const int SUN_COLOUR_COLUMNS = 8;
const int SUN_COLOUR_ROWS = 32;

/// Heights in a cloud at which the light of fog is known, from its bottom to its top.
const int FOG_SKY_HEIGHTS = 16;

/// A cell of an alias table, and what a photon from it weighs for each m² that it sees of the cloud's box.
struct SkyCell {
    float keep;  // probability that the cell itself is meant, and not `other`
    uint other;
    vec3 low;   // where it enters at the bottom of the cloud [1/m²]
    vec3 high;  // and at its top
};

/// Where a voxel lies between the ends of a cloud: along the sun's azimuth, and by height; 0 to 1.
struct AirPlace {
    vec3 across;  // per voxel
    vec3 up;      // per voxel
    vec2 origin;
};

SHARED_FN vec2 airPlace(AirPlace air, vec3 voxel) {
    return clamp(vec2(dot(air.across, voxel), dot(air.up, voxel)) + air.origin, vec2(0.0F), vec2(1.0F));
}

#ifdef __cplusplus
static_assert(sizeof(SkyCell) == 32 && offsetof(SkyCell, high) == 20);
static_assert(sizeof(AirPlace) == 32 && offsetof(AirPlace, origin) == 24);
#endif

SHARED_END

#endif
