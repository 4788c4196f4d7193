// The sun's disc behind the cloud.
#ifndef LUMULUS_LIB_DISC
#define LUMULUS_LIB_DISC

#include "shared/draw.h"
#include "shared/phase.h"

/// Radiance of the sun's disc where the view meets it.
vec3 discSeen(LightParams light, vec3 direction) {
    return angleBetween(light.sunTravel, -direction).oneMinusCos <= light.sunCone ? light.sunDisc : vec3(0.0);
}

#endif
