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

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe.
SkyPassParams params;
#include "lib/sky_radiance.glsl"

void main() {
    params = storedParams;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    const ivec2 ofPicture = params.first + pixel;
    vec4 front = imageLoad(cloud, pixel);
    const float seen = imageLoad(radiance, pixel).a;
    if (front.a > 0.0) {
        front.rgb = throughAir(front, ofPicture, texelFetch(depth, pixel, 0).r);
        imageStore(cloud, pixel, front);
    }
    imageStore(radiance, pixel, vec4(front.rgb + (1.0 - front.a) * skyOfPixel(ofPicture, false), seen));
}
