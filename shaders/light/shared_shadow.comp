#version 460
#extension GL_GOOGLE_include_directive : require
// Optical depth to the sun through all instances, at the texels of the shadow volume of one of them: the sum of what each
// one's own shadow volume has there. Behind an instance it is the depth of the whole column, before it and beside it nothing.
#include "shared/instance.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D own;  // atlas of the volumes of each instance by itself
layout(binding = 1) uniform writeonly image3D together;
layout(binding = 2, scalar) readonly buffer Occluders { Occluder occluders[]; };
layout(push_constant, scalar) uniform Push { SharedShadowPush push; };

/// Half floats end at 65504; behind 6e4 no light is left.
const float DARK = 6.0e4;

void main() {
    const uint number = linearInvocation(64u);
    const uvec3 size = uvec3(push.size);
    if (number >= size.x * size.y * size.z) return;
    const ivec3 texel = cellNumbered(number, push.size);
    const vec3 inverseSize = 1.0 / vec3(textureSize(own, 0));
    float depth = 0.0;
    for (uint i = push.first; i < push.first + push.occluders; ++i) {
        const Occluder occluder = occluders[i];
        const vec3 place = occluder.texelToTexel * vec3(texel) + occluder.offset;
        const bool beside = any(lessThan(place.xy, vec2(0.0))) || any(greaterThan(place.xy, occluder.size.xy));
        if (beside || place.z <= 0.5) continue;
        const vec3 inside = clamp(place, vec3(0.5), occluder.size - 0.5);
        depth += textureLod(own, (occluder.origin + inside) * inverseSize, 0.0).r;
    }
    imageStore(together, push.origin + texel, vec4(min(depth, DARK)));
}
