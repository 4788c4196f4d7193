#version 460
#extension GL_GOOGLE_include_directive : require
// A frame as seen through the fog, from its filtered layers: the cloud, and behind it the sky without the light that
// the cloud takes out of it, and with the light that the background has more.
#include "shared/fog_layers.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform image2D cloud;     // alpha: how much of the pixel it covers
layout(binding = 1, rgba32f) uniform image2D radiance;  // alpha stays as it is
layout(binding = 2) uniform sampler2D seenCloud;
layout(binding = 3) uniform sampler2D shadow;
layout(binding = 4) uniform sampler2D bright;
layout(binding = 5) uniform sampler2D openSky;   // of the wanted part, or one texel for all pixels
layout(binding = 6) uniform sampler2D ownLight;  // of the fog where no cloud is, as openSky
layout(push_constant, scalar) uniform Push { FogJoinPush push; };
#include "lib/uniform_layer.glsl"

void main() {
    const ivec2 place = ivec2(gl_GlobalInvocationID.xy), pixel = push.first + place;
    if (any(greaterThanEqual(place, push.size))) return;
    const float cover = imageLoad(cloud, pixel).a, transmittance = imageLoad(radiance, pixel).a;
    const vec3 front = push.clouded != 0u ? texelFetch(seenCloud, pixel, 0).rgb : vec3(0.0);
    const vec3 taken = push.clouded != 0u ? texelFetch(shadow, pixel, 0).rgb : vec3(0.0);
    const vec3 more = push.lit != 0u ? texelFetch(bright, pixel, 0).rgb : vec3(0.0);
    precise const vec3 open = layerTexel(openSky, place).rgb + (1.0 - cover) * layerTexel(ownLight, place).rgb;
    // light of the sky cannot be less than none, wherever the cloud's blurred shadow falls
    precise const vec3 behind = max(open - taken, 0.0) + more;
    precise const vec3 seen = front + behind;
    imageStore(cloud, pixel, vec4(front, cover));
    imageStore(radiance, pixel, vec4(seen, transmittance));
}
