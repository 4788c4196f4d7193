// Interface structs of a frame in fog: the layers that it is split into for the filter.
#ifndef LUMULUS_SHARED_FOG_LAYERS_H
#define LUMULUS_SHARED_FOG_LAYERS_H

#include "shared/prelude.h"

SHARED_BEGIN

/// What the layers hold: a layer that is black is not filtered.
struct LayerSummary {
    uint clouded;   // not 0: a pixel has some cloud
    uint lit;       // not 0: light of a pixel's background is more than the sky's
    uint farthest;  // bits of the largest depth, which is not negative
};

struct FogSplitPush {
    ivec2 size;
    vec3 sky;
};

/// The part of the picture that is wanted, and which layers have been filtered.
struct FogJoinPush {
    ivec2 first;
    ivec2 size;
    uint clouded;
    uint lit;
};

#ifdef __cplusplus
static_assert(sizeof(LayerSummary) == 12 && offsetof(LayerSummary, farthest) == 8);
static_assert(sizeof(FogSplitPush) == 20 && offsetof(FogSplitPush, sky) == 8);
static_assert(sizeof(FogJoinPush) == 24 && offsetof(FogJoinPush, lit) == 20);
#endif

SHARED_END

#endif
