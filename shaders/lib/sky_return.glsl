// What the sky adds to a ray where light goes to and fro along it (shared/sky_return.h). The includer declares `params`.
#ifndef LUMULUS_LIB_SKY_RETURN
#define LUMULUS_LIB_SKY_RETURN

#include "shared/sky_return.h"

layout(constant_id = 9) const bool SKY_RETURN = false;  // the phase function has a backward peak and the sky differs by direction
layout(binding = 16) uniform sampler3D skyReturn;

/// Radiance that comes along a direction of view through a cloud of this optical depth, beyond what the photon map has. It
/// may be negative.
vec3 returnedSky(vec3 direction, float depth) {
    const vec3 towards = direction * params.skyAxes;
    const float azimuth = fract(atan(towards.z, towards.x) / 6.28318531 + 1.0);
    const float down = acos(clamp(towards.y, -1.0, 1.0)) / 3.14159265;
    return textureLod(skyReturn, skyReturnPlace(azimuth, down, depth), 0.0).rgb;
}

#endif
