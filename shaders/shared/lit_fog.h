// Fog in the light of sun and sky, as a picture shows it.
#ifndef LUMULUS_SHARED_LIT_FOG_H
#define LUMULUS_SHARED_LIT_FOG_H

#include "shared/draw.h"
#include "shared/fog.h"
#include "shared/fog_light.h"

SHARED_BEGIN

/// Heights are metres; places relative to the eye.
struct LitFogParams {
    ViewParams view;
    ivec2 first;  // pixel of the picture where the frame begins
    vec3 toSun;
    vec3 sunIrradiance;  // above the fog
    vec2 sunAcross;      // horizontal direction towards the sun, x and z
    float eyeHeight;     // above the lowest level
    float height;        // of the highest level above the lowest
    int levels;
    int media;          // fog, in the order of the tables
    float aboveGround;  // of the eye; where there is a ground
    int casters;
    vec3 inverseShadows;  // 1 / size of the image of all shadow volumes
    vec3 sky;             // radiance behind all fog, where it is the same everywhere
    int airMedia;         // of the air in the fog, after those of the fog
    float aboveTop;       // of the eye above the fog; below 0 within it
    float planetHeight;   // of the eye above the middle of the planet
    vec3 up;              // at the eye
    // Light that clouds change (light/fog_change/fog_change.h): points of its table, and where that begins and ends [m]
    vec3 changeSize;
    float changeNear;
    float changeFar;
    int meshes;  // 1: they throw shadows, and are one more caster behind those of the clouds
};

/// Angle within which light that fog scatters may count as not scattered [radians], and its cosine.
const float FOG_CUT = 0.26F;
const float FOG_CUT_COSINE = 0.96639F;

/// Share of light that a Henyey–Greenstein phase function scatters in its peak: that within the cut beyond the value
/// there.
SHARED_FN float peakShare(float g) {
    if (g < 0.01F) return 0.0F;
    const float there = sqrt(1.0F + g * g - 2.0F * g * FOG_CUT_COSINE);
    const float within = (1.0F - g * g) / (2.0F * g) * (1.0F / (1.0F - g) - 1.0F / there);
    return max(within - 6.28318531F * (1.0F - FOG_CUT_COSINE) * fogPhase(g, FOG_CUT_COSINE), 0.0F);
}

/// What the light of clouds has more or less than that of the fog without them: whether any pixel has some.
struct LitFogSummary {
    uint more;
    uint less;
    uint farthest;  // bits of the largest distance [m]
};

/// A cloud that throws a shadow, ten texels: rows from places to voxels; size in voxels; rows from voxels to texture
/// coordinates of its shadow volume; where the volume begins in the image of all, and how large it is [texels]; optical
/// depth of the truncated medium per true one. Of meshes: rows from places to the box around all of them, as the sun
/// sees it; its size; rows from places to texels of the map of their heights, and height; three of zeros.
const int CASTER_TEXELS = 10;

#ifdef __cplusplus
static_assert(sizeof(LitFogParams) == 192 && offsetof(LitFogParams, meshes) == 188);
static_assert(sizeof(LitFogSummary) == 12 && offsetof(LitFogSummary, farthest) == 8);
#endif

SHARED_END

#endif
