// The sky as seen from one point: a table by direction, in the frame of the upward direction and the sun.
#ifndef LUMULUS_SHARED_SKY_VIEW_H
#define LUMULUS_SHARED_SKY_VIEW_H

#include "shared/draw.h"
#include "shared/prelude.h"

#ifdef __cplusplus
namespace lumulus::shared {
using glm::acos;
using glm::asin;
}  // namespace lumulus::shared
#endif

SHARED_BEGIN

/// Columns from the sun's azimuth to that opposite to it, denser at the sun; rows from the horizon to the zenith,
/// denser at the horizon; then rows of the ground, from the point below the eye to the horizon.
const int SKY_COLUMNS = 64;
const int SKY_ROWS = 112;
const int GROUND_ROWS = 32;

/// Texels of the air between the eye and clouds: across and down the picture, and along the ray.
const int AIR_SLICES = 32;

/// Angles in radians, lengths in metres.
struct SkyViewParams {
    vec3 up;         // at the eye
    vec3 sunAcross;  // horizontal direction towards the sun
    vec3 toSun;
    float height;           // of the eye above the ground
    float planetHeight;     // of the eye above the middle of the planet
    float horizon;          // elevation of the horizon
    float highest;          // angle above the horizon at which the table ends
    float horizonDistance;  // of the ground's last point
    float asymmetry;        // g of the aerosol's phase function
};

/// Angle above the horizon, below 0 where the ground is seen.
SHARED_FN float aboveHorizon(SkyViewParams sky, vec3 direction) {
    return asin(clamp(dot(sky.up, direction), -1.0F, 1.0F)) - sky.horizon;
}

/// Where a direction lies in the table, as texture coordinates. `above` is its angle above the horizon.
SHARED_FN vec2 skyViewPlace(SkyViewParams sky, vec3 direction, float above) {
    const float up = clamp(dot(sky.up, direction), -1.0F, 1.0F);
    const vec3 level = direction - up * sky.up;
    const float across = sqrt(max(dot(level, level), 1.0e-20F));
    const float azimuth = acos(clamp(dot(level, sky.sunAcross) / across, -1.0F, 1.0F));
    const float x = sqrt(azimuth * 0.318309886F) * float(SKY_COLUMNS - 1) + 0.5F;
    float y = sqrt(clamp(above / sky.highest, 0.0F, 1.0F)) * float(SKY_ROWS - 1) + 0.5F;
    if (above < 0.0F) {
        const float b = sky.planetHeight * up, c = sky.horizonDistance * sky.horizonDistance;
        const float ground = c / (sqrt(max(b * b - c, 0.0F)) - b);
        const float far = clamp((ground - sky.height) / (sky.horizonDistance - sky.height), 0.0F, 1.0F);
        y = float(SKY_ROWS) + sqrt(far) * float(GROUND_ROWS - 1) + 0.5F;
    }
    return vec2(x / float(SKY_COLUMNS), y / float(SKY_ROWS + GROUND_ROWS));
}

/// Phase function of aerosol [1/sr] (Cornette and Shanks 1992).
SHARED_FN float aerosolPhase(float g, float cosine) {
    const float away = max(1.0F + g * g - 2.0F * g * cosine, 1.0e-6F);
    return 0.119366207F * (1.0F - g * g) * (1.0F + cosine * cosine) / ((2.0F + g * g) * away * sqrt(away));
}

/// The sky of a picture, and the air before its clouds.
struct SkyPassParams {
    ViewParams view;
    SkyViewParams sky;
    ivec2 first;       // pixel of the picture where the frame begins
    float pixelAngle;  // of a pixel [radians]
    float nearest;     // distance of the air's first slice [m]
    float farthest;    // and of its last
    SkyViewParams moon;
};

/// The same where there is level fog.
struct SkyFogParams {
    SkyPassParams sky;
    int aboveFog;  // not 0: the eye is above the fog, whose light is in the picture already
};

#ifdef __cplusplus
static_assert(sizeof(SkyViewParams) == 60 && offsetof(SkyViewParams, asymmetry) == 56);
static_assert(sizeof(SkyPassParams) == 196 && offsetof(SkyPassParams, moon) == 136);
static_assert(sizeof(SkyFogParams) == 200 && offsetof(SkyFogParams, aboveFog) == 196);
#endif

SHARED_END

#endif
