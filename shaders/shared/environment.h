// What surrounds the world: the one place in which shaders learn what the sky is.
#ifndef LUMULUS_SHARED_ENVIRONMENT_H
#define LUMULUS_SHARED_ENVIRONMENT_H

#include "shared/prelude.h"

SHARED_BEGIN

/// A sky of the same radiance everywhere.
struct EnvironmentParams {
    vec3 radiance;  // W/(m² sr) per channel
};

/// Radiance that arrives from a direction, a unit vector away from the observer: from all the same.
SHARED_FN vec3 environmentRadiance(EnvironmentParams environment, vec3 /*direction*/) {
    return environment.radiance;
}

/// 1 − cos of the angle to the inward normal of a face at which the environment's light enters through it, for `u` in
/// [0,1): cos² θ is uniform, without cancellation. The azimuth is uniform.
SHARED_FN float environmentOneMinusCos(float u) {
    return u / (1.0F + sqrt(1.0F - u));
}

SHARED_END

#endif
