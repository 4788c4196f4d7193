#version 460
#extension GL_GOOGLE_include_directive : require
// A map of the surroundings behind the clouds of a picture.
#include "shared/frame.h"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform readonly image2D cloud;
layout(binding = 1, rgba32f) uniform image2D radiance;  // alpha: transmittance of the cloud
layout(binding = 2, scalar) readonly buffer Params { SkyMapParams storedParams; };
layout(binding = 3) uniform sampler2D map;  // latitude by longitude, with a column more on either side

void main() {
    const SkyMapParams params = storedParams;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < params.samples * params.samples; ++i) {
        vec3 origin, direction;
        viewRay(params.view, params.samples * (params.first + pixel) + ivec2(i % params.samples, i / params.samples),
                params.samples, origin, direction);
        const vec3 local = params.toMap * direction;
        const vec2 level = abs(local.x) + abs(local.z) > 0.0 ? local.xz : vec2(1.0, 0.0);
        const float turn = fract(atan(level.y, level.x) * 0.159154943 + 1.0);
        const float down = atan(length(level), local.y) * 0.318309886;
        const vec2 place = vec2((turn * params.size.x + 1.0) / (params.size.x + 2.0), down);
        sum += textureLod(map, place, 0.0).rgb;
    }
    const vec4 front = imageLoad(cloud, pixel);
    const float seen = imageLoad(radiance, pixel).a;
    const vec3 sky = sum / float(params.samples * params.samples);
    imageStore(radiance, pixel, vec4(front.rgb + (1.0 - front.a) * sky, seen));
}
