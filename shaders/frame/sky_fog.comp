#version 460
#extension GL_GOOGLE_include_directive : require
// The atmosphere above level fog in a picture: the sky behind clouds and fog, and the air above the fog between them and the
// eye. Where the eye is in the fog this comes before the fog, where it is above after it.
#include "shared/frame.h"
#include "shared/sky_view.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform image2D cloud;
layout(binding = 1, rgba32f) uniform image2D radiance;  // alpha: transmittance of the cloud
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3, scalar) readonly buffer Params { SkyFogParams storedParams; };
layout(binding = 32) uniform sampler2D skyTransmittance;  // of what is seen of the fog's top, by row
layout(binding = 33, rgba32f) uniform writeonly image2D skyBehind;

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe.
SkyPassParams params;
#include "lib/sky_radiance.glsl"

/// Of the air above the fog, down to its top; nothing is seen through the air elsewhere.
vec3 throughToFog(ivec2 pixel) {
    vec3 origin, direction;
    viewRay(params.view, pixel, 1, origin, direction);
    const float above = aboveHorizon(params.sky, direction);
    if (above >= 0.0) return vec3(0.0);
    return textureLod(skyTransmittance, vec2(0.5, skyViewPlace(params.sky, direction, above).y), 0.0).rgb;
}

void main() {
    params = storedParams.sky;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    const ivec2 ofPicture = params.first + pixel;
    vec4 front = imageLoad(cloud, pixel);
    const vec4 seen = imageLoad(radiance, pixel);
    vec3 behind = seen.rgb - front.rgb;
    if (front.a > 0.0) {
        front.rgb = throughAir(front, ofPicture, texelFetch(depth, pixel, 0).r);
        imageStore(cloud, pixel, front);
    }
    const vec3 sky = skyOfPixel(ofPicture, storedParams.aboveFog != 0);
    imageStore(skyBehind, pixel, vec4(sky, 1.0));
    behind = (1.0 - front.a) * sky + (storedParams.aboveFog != 0 ? throughToFog(ofPicture) * behind : vec3(0.0));
    imageStore(radiance, pixel, vec4(front.rgb + behind, seen.a));
}
