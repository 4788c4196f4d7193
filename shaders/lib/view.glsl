// Rays through pixels, relative to the eye; the float twin of Camera::ray.
#ifndef LUMULUS_LIB_VIEW
#define LUMULUS_LIB_VIEW

#include "shared/draw.h"

/// The ray through the middle of a part of a pixel (rows from the top), of which there are `samples` along each side:
/// origin and unit direction.
void viewRay(ViewParams view, ivec2 part, int samples, out vec3 origin, out vec3 direction) {
    const vec2 place = (vec2(part) + 0.5) / vec2(view.size * samples);
    const vec2 plane = vec2(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
    origin = vec3(0.0);
    if (view.projection == PROJECTION_ORTHOGRAPHIC) {
        origin = plane.x * view.halfExtent.x * view.right + plane.y * view.halfExtent.y * view.up;
        direction = view.forward;
    } else if (view.projection == PROJECTION_PANORAMA) {
        const float azimuth = 3.14159265 * plane.x, elevation = 1.57079633 * plane.y;
        direction = cos(elevation) * (sin(azimuth) * view.right + cos(azimuth) * view.forward) + sin(elevation) * view.up;
    } else {
        direction = normalize(view.forward + plane.x * view.halfExtent.x * view.right +
                              plane.y * view.halfExtent.y * view.up);
    }
}

#endif
