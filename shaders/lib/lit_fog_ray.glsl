// Rays of a picture in level fog. The includer declares `params` and AIR.
#ifndef LUMULUS_LIB_LIT_FOG_RAY
#define LUMULUS_LIB_LIT_FOG_RAY

#include "shared/lit_fog.h"
#include "lib/view.glsl"

struct Ray {
    vec3 origin, direction;
    vec3 start, towards;  // the same in the world, where fog is round as the planet
    float entry;          // distance from the eye at which it begins
    float row;      // of the tables, for looking along it
    float column;
    float side;     // 0: upwards, 1: downwards
    float cosine;   // to the sun
};

/// Moves a ray from above to where it meets the fog, which is level there. False: it misses it.
bool enterFog(inout Ray ray) {
    const float rises = dot(ray.origin, params.up);
    const float above = max(params.aboveTop + rises, 0.0), planet = params.planetHeight + rises;
    const float b = planet * dot(ray.direction, params.up), c = above * (2.0 * planet - above), root = b * b - c;
    if (b >= 0.0 || root <= 0.0) return false;
    ray.entry = c / (sqrt(root) - b);
    const float up = -sqrt(root) / (planet - above);
    const vec2 level = ray.direction.xz, across = level * inversesqrt(max(dot(level, level), 1.0e-20));
    ray.start += ray.entry * ray.towards;
    ray.origin = vec3(0.0, -params.aboveTop, 0.0);
    ray.direction = vec3(across * sqrt(max(1.0 - up * up, 0.0)), up).xzy;
    return true;
}

/// The ray of a pixel in the fog. False: it meets none.
bool rayOf(ivec2 pixel, out Ray ray) {
    viewRay(params.view, pixel, 1, ray.origin, ray.direction);
    ray.start = ray.origin;
    ray.towards = ray.direction;
    ray.entry = 0.0;
    if (AIR && params.aboveTop > 0.0 && !enterFog(ray)) return false;
    const vec2 level = ray.direction.xz;
    const float across = dot(level, level);
    ray.row = fogRow(ray.direction.y);
    ray.column = fogColumn(across > 1.0e-12 ? dot(level, params.sunAcross) * inversesqrt(across) : 1.0);
    ray.side = ray.direction.y < 0.0 ? 1.0 : 0.0;
    ray.cosine = dot(ray.direction, params.toSun);
    return true;
}

#endif
