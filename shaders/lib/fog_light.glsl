// What fog makes of a picture's light before it is filtered. The includer declares radiance, distances, Media and `push`.
#ifndef LUMULUS_LIB_FOG_LIGHT
#define LUMULUS_LIB_FOG_LIGHT

#include "shared/fog.h"
#include "lib/uniform_layer.glsl"
#include "lib/view.glsl"

struct FogLight {
    vec3 sharp;      // attenuated and emitted light, which stays in its pixel
    vec3 scattered;
    float spread;    // standard deviation, pixels
};

FogLight fogLight(ivec2 pixel) {
    vec3 origin, direction;
    viewRay(push.view, pixel, 1, origin, direction);
    const vec4 seen = texelFetch(radiance, pixel, 0);  // alpha: how much of the pixel the layer covers
    const float distance_ = layerTexel(distances, pixel).r;
    FogPath path = clearPath();
    for (int i = 0; i < push.media; ++i)
        addMedium(path, media[i], densityIntegral(media[i], origin, direction, distance_, push.skyDistance));
    FogLight light;
    const vec3 share = scatteredShare(path);
    light.sharp = attenuatedShare(path) * seen.rgb + seen.a * emittedRadiance(path);
    // what other renderers leave below zero has no luminance to be weighed by: it stays where it is
    light.sharp += share * min(seen.rgb, 0.0);
    light.scattered = share * max(seen.rgb, 0.0);
    const float angle = sqrt(spreadVariance(path));
    const bool flat_ = push.view.projection == PROJECTION_ORTHOGRAPHIC;
    const float scale = push.pixelsPerRadian * (flat_ ? min(distance_, push.skyDistance) : 1.0);
    light.spread = min(angle * scale, MAX_SPREAD);
    return light;
}

#endif
