// Interface structs of the frame: layers of a picture on the GPU.
#ifndef LUMULUS_SHARED_FRAME_H
#define LUMULUS_SHARED_FRAME_H

#include "shared/draw.h"

SHARED_BEGIN

/// A pixel that sees the sun's disc.
struct SunPixel {
    ivec2 pixel;
    vec3 radiance;  // of the disc alone, before the cloud
};

/// What is seen where no cloud is, in the whole picture but for a rectangle.
struct BackgroundPush {
    ivec2 size;
    ivec2 withoutFirst;
    ivec2 withoutSize;
    vec3 radiance;
};

struct SunPixelsPush {
    int count;
};

/// A rectangle of the picture, whose pixels lie in a buffer row by row.
struct BandPush {
    ivec2 first;
    ivec2 size;
};

/// A picture of the surroundings behind the clouds.
struct SkyMapParams {
    ViewParams view;
    mat3 toMap;   // of directions: from the world to the frame of the map (sky/map_sky.h)
    vec2 size;    // of the map, pixels, without the column on either side that repeats the other
    ivec2 first;  // pixel of the picture where the frame begins
    int samples;  // rays along each side of a pixel
};

#ifdef __cplusplus
static_assert(sizeof(SkyMapParams) == 112 && offsetof(SkyMapParams, samples) == 108);
static_assert(sizeof(SunPixel) == 20 && offsetof(SunPixel, radiance) == 8);
static_assert(sizeof(BackgroundPush) == 36 && offsetof(BackgroundPush, radiance) == 24);
static_assert(sizeof(SunPixelsPush) == 4);
static_assert(sizeof(BandPush) == 16 && offsetof(BandPush, size) == 8);
#endif

SHARED_END

#endif
