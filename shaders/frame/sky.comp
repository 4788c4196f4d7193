#version 460
#extension GL_GOOGLE_include_directive : require
// The atmosphere in a picture: the sky and the ground behind the clouds, and the air between them and the eye.
#include "shared/frame.h"
#include "shared/sky_view.h"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform image2D cloud;
layout(binding = 1, rgba32f) uniform image2D radiance;  // alpha: transmittance of the cloud
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3, scalar) readonly buffer Params { SkyPassParams storedParams; };
layout(binding = 4) uniform sampler2D skyScattered;  // all but light that aerosol scattered once
layout(binding = 5) uniform sampler2D skyAerosol;    // that, without its phase function
layout(binding = 6) uniform sampler3D airLight;
layout(binding = 7) uniform sampler3D airTransmittance;

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe.
SkyPassParams params;

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

/// Mean over a pixel.
vec3 skyOfPixel(ivec2 pixel) {
    vec3 origin, direction;
    viewRay(params.view, pixel, 1, origin, direction);
    if (abs(aboveHorizon(params.sky, direction)) > 1.5 * params.pixelAngle) return skyRadiance(params.sky, direction);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < ACROSS_HORIZON * ACROSS_HORIZON; ++i) {
        viewRay(params.view, ACROSS_HORIZON * pixel + ivec2(i % ACROSS_HORIZON, i / ACROSS_HORIZON), ACROSS_HORIZON,
                origin, direction);
        sum += skyRadiance(params.sky, direction);
    }
    return sum / float(ACROSS_HORIZON * ACROSS_HORIZON);
}

void main() {
    params = storedParams;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    const ivec2 ofPicture = params.first + pixel;
    vec4 front = imageLoad(cloud, pixel);
    const float seen = imageLoad(radiance, pixel).a;
    if (front.a > 0.0) {
        const float away = texelFetch(depth, pixel, 0).r - params.nearest;
        const float slice = sqrt(clamp(away / (params.farthest - params.nearest), 0.0, 1.0)) * float(AIR_SLICES - 1);
        const vec3 place = vec3((vec2(ofPicture) + 0.5) / vec2(params.view.size), (slice + 0.5) / float(AIR_SLICES));
        front.rgb = front.rgb * textureLod(airTransmittance, place, 0.0).rgb +
                    front.a * textureLod(airLight, place, 0.0).rgb;
        imageStore(cloud, pixel, front);
    }
    imageStore(radiance, pixel, vec4(front.rgb + (1.0 - front.a) * skyOfPixel(ofPicture), seen));
}
