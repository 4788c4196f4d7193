// Photons enter through the faces of the cloud's box: exact for any affine box, and none is shot past it.
#ifndef LUMULUS_LIB_EMISSION
#define LUMULUS_LIB_EMISSION

#include "shared/environment.h"
#include "shared/phase.h"

/// x, y or z, by weights; u in [0,1).
bvec3 chooseAxis(vec3 weights, float u) {
    const float pick = u * (weights.x + weights.y + weights.z);
    const bool x = pick < weights.x, y = !x && pick < weights.x + weights.y;
    return bvec3(x, y, !x && !y);
}

vec3 faceArea(TraceParams params, bvec3 axis) {
    return axis.x ? params.faceArea[0] : (axis.y ? params.faceArea[1] : params.faceArea[2]);
}

/// Directions of a light before it enters, as an angle about an axis, uniform in azimuth: the sun's disc, uniform over
/// its solid angle, or a constant sky, cosine-distributed inwards of a face that `choice` and `side` choose.
vec3 lightAxis(TraceParams params, bool ofSun, float choice, float side) {
    const vec3 area = faceArea(params, chooseAxis(params.faceSize, choice));
    const vec3 inwards = (side < 0.5 ? -area : area) * inversesqrt(dot(area, area));
    return ofSun ? params.sunDirection : inwards;
}

/// 1 − cos of the angle to lightAxis().
float lightOneMinusCos(TraceParams params, bool ofSun, float u) {
    return ofSun ? params.sunCone * u : environmentOneMinusCos(u);
}

/// Where light of this direction enters, in voxel coordinates: uniform over the projection of the box, whose `area` is that
/// which the direction sees [m²], or over the faces (a constant sky; `choice` as above).
vec3 entryPoint(TraceParams params, bool byProjection, vec3 direction, vec2 u, float choice, out float area) {
    const vec3 through = vec3(dot(params.faceArea[0], direction), dot(params.faceArea[1], direction),
                              dot(params.faceArea[2], direction));
    const vec3 weights = byProjection ? abs(through) : params.faceSize;
    area = weights.x + weights.y + weights.z;
    const bvec3 axis = chooseAxis(weights, choice);
    const vec3 inside = params.size * vec3(u.x, axis.z ? u.y : u.x, u.y);
    return mix(inside, mix(vec3(0.0), params.size, lessThan(through, vec3(0.0))), axis);
}

#endif
