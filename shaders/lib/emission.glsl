// Photons enter through the faces of the cloud's box: exact for any affine box, and none is shot past it.
#ifndef LUMULUS_LIB_EMISSION
#define LUMULUS_LIB_EMISSION

#include "shared/phase.h"

/// A point on one of the six faces, in voxel coordinates, the face chosen by `weights` (x, y, z; either side by `side`).
vec3 entryPoint(vec3 weights, bvec3 upper, vec2 u, float choice, vec3 size, out int axis) {
    const float pick = choice * (weights.x + weights.y + weights.z);
    axis = pick < weights.x ? 0 : (pick < weights.x + weights.y ? 1 : 2);
    vec3 point;
    point[axis] = upper[axis] ? size[axis] : 0.0;
    point[(axis + 1) % 3] = u.x * size[(axis + 1) % 3];
    point[(axis + 2) % 3] = u.y * size[(axis + 2) % 3];
    return point;
}

vec3 flux(TraceParams params, vec3 direction) {
    return abs(vec3(dot(params.faceArea[0], direction), dot(params.faceArea[1], direction),
                    dot(params.faceArea[2], direction)));
}

/// A photon of the sun's disc: uniform over the disc and over the projection of the box. Returns its weight: the
/// projected area for this direction against that for the disc's middle.
float emitSun(TraceParams params, vec4 u, vec4 v, out vec3 point, out vec3 direction) {
    direction = rotateDirection(params.sunDirection, angleFromOneMinusCos(params.sunCone * u.x), 6.28318531 * u.y);
    const vec3 through = flux(params, direction);
    const vec3 middle = flux(params, params.sunDirection);
    const bvec3 upper = bvec3(dot(params.faceArea[0], direction) < 0.0, dot(params.faceArea[1], direction) < 0.0,
                              dot(params.faceArea[2], direction) < 0.0);
    int axis;
    point = entryPoint(through, upper, v.xy, v.z, params.size, axis);
    return (through.x + through.y + through.z) / (middle.x + middle.y + middle.z);
}

/// A photon of a constant sky: uniform over the box's faces, cosine-distributed inwards.
void emitSky(TraceParams params, vec4 u, vec4 v, out vec3 point, out vec3 direction) {
    const vec3 areas = vec3(length(params.faceArea[0]), length(params.faceArea[1]), length(params.faceArea[2]));
    const bvec3 upper = bvec3(u.z < 0.5);
    int axis;
    point = entryPoint(areas, upper, v.xy, v.z, params.size, axis);
    const vec3 inwards = (upper[axis] ? -1.0 : 1.0) * params.faceArea[axis] / areas[axis];
    // cos² θ uniform: sin² = u; 1 − cos without cancellation
    const float sine = sqrt(u.x), cosine = sqrt(1.0 - u.x);
    const ScatterAngle angle = ScatterAngle(u.x / (1.0 + cosine), 1.0 + cosine, sine);
    direction = rotateDirection(inwards, angle, 6.28318531 * u.y);
}

#endif
