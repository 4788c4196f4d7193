// Light of a sky that differs by direction and is sent to and fro along a line of sight, where a phase function has a
// backward peak: a table by the direction of view and by optical depth (light/photon/sky_return.h).
#ifndef LUMULUS_SHARED_SKY_RETURN_H
#define LUMULUS_SHARED_SKY_RETURN_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Azimuths, the first one again behind the last; elevations in the middles of rows from the zenith down; and optical
/// depths, evenly by τ/(1 + τ) from none to all.
const int SKY_RETURN_COLUMNS = 64;
const int SKY_RETURN_ROWS = 64;
const int SKY_RETURN_DEPTHS = 16;

/// Texture coordinates, by the azimuth from that of the sky's first column as a share of all round, by the angle to the
/// zenith over π, and by the optical depth.
SHARED_FN vec3 skyReturnPlace(float azimuth, float down, float depth) {
    const float columns = float(SKY_RETURN_COLUMNS), depths = float(SKY_RETURN_DEPTHS);
    return vec3((azimuth * columns + 0.5F) / (columns + 1.0F), down,
                (depth / (1.0F + depth) * (depths - 1.0F) + 0.5F) / depths);
}

SHARED_END

#endif
