// The light of an atmosphere's sky by direction, and the air between the eye and the clouds. The includer declares `params`.
#ifndef LUMULUS_LIB_SKY_RADIANCE
#define LUMULUS_LIB_SKY_RADIANCE

#include "shared/sky_view.h"
#include "lib/view.glsl"

layout(binding = 4) uniform sampler2D skyScattered;  // all but light that aerosol scattered once
layout(binding = 5) uniform sampler2D skyAerosol;    // that, without its phase function
layout(constant_id = 18) const bool MOON = false;    // there is a second sun
layout(binding = 8) uniform sampler2D moonScattered;  // as those of the sun
layout(binding = 9) uniform sampler2D moonAerosol;
layout(binding = 6) uniform sampler3D airLight;
layout(binding = 7) uniform sampler3D airTransmittance;

/// Rays along each side of a pixel that the horizon crosses.
const int ACROSS_HORIZON = 4;

vec3 skyRadiance(SkyViewParams sky, vec3 direction) {
    const float above = aboveHorizon(sky, direction);
    const vec2 place = skyViewPlace(sky, direction, above);
    const vec3 aerosol = textureLod(skyAerosol, place, 0.0).rgb;
    const vec3 seen = textureLod(skyScattered, place, 0.0).rgb +
                      aerosolPhase(sky.asymmetry, dot(direction, sky.toSun)) * aerosol;
    return above <= sky.highest ? max(seen, 0.0) : vec3(0.0);
}

vec3 moonlitRadiance(SkyViewParams sky, vec3 direction) {
    const float above = aboveHorizon(sky, direction);
    const vec2 place = skyViewPlace(sky, direction, above);
    const vec3 seen = textureLod(moonScattered, place, 0.0).rgb +
                      aerosolPhase(sky.asymmetry, dot(direction, sky.toSun)) * textureLod(moonAerosol, place, 0.0).rgb;
    return above <= sky.highest ? max(seen, 0.0) : vec3(0.0);
}

vec3 allRadiance(vec3 direction) {
    const vec3 sunlit = skyRadiance(params.sky, direction);
    return MOON ? sunlit + moonlitRadiance(params.moon, direction) : sunlit;
}

/// Mean over a pixel; `ofMiddle`: what its middle sees stands for all of it, as where what lies below the horizon is drawn so.
vec3 skyOfPixel(ivec2 pixel, bool ofMiddle) {
    vec3 origin, direction;
    viewRay(params.view, pixel, 1, origin, direction);
    if (ofMiddle || abs(aboveHorizon(params.sky, direction)) > 1.5 * params.pixelAngle) return allRadiance(direction);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < ACROSS_HORIZON * ACROSS_HORIZON; ++i) {
        viewRay(params.view, ACROSS_HORIZON * pixel + ivec2(i % ACROSS_HORIZON, i / ACROSS_HORIZON), ACROSS_HORIZON,
                origin, direction);
        sum += allRadiance(direction);
    }
    return sum / float(ACROSS_HORIZON * ACROSS_HORIZON);
}

/// Light of a cloud at a distance, as it comes through the air.
vec3 throughAir(vec4 front, ivec2 pixel, float distance_) {
    const float away = distance_ - params.nearest;
    const float slice = sqrt(clamp(away / (params.farthest - params.nearest), 0.0, 1.0)) * float(AIR_SLICES - 1);
    const vec3 place = vec3((vec2(pixel) + 0.5) / vec2(params.view.size), (slice + 0.5) / float(AIR_SLICES));
    return front.rgb * textureLod(airTransmittance, place, 0.0).rgb + front.a * textureLod(airLight, place, 0.0).rgb;
}

#endif
