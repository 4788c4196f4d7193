#version 460
#extension GL_GOOGLE_include_directive : require
// Optical depth to the sun through all instances, at the texels of the shadow volume of one of them: the sum of what each
// one's own shadow volume has there. Behind an instance it is the depth of the whole column, before it and beside it nothing.
// Columns are filled in segments. What the other instances add is found at both ends, and between them only where it differs
// and there is density, since light is looked up nowhere else.
#include "shared/instance.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D own;  // atlas of the volumes of each instance by itself
layout(binding = 1) uniform writeonly image3D together;  // with the same places
layout(binding = 2, rgba32f) uniform readonly imageBuffer occluders;
layout(push_constant, scalar) uniform Push { SharedShadowPush push; };

/// Half floats end at 65504; behind 6e4 no light is left.
const float DARK = 6.0e4;

/// Optical depth of other instances that is interpolated between the ends of a segment.
const float INTERPOLATED = 0.02;

vec4 occluderTexel(uint occluder, int texel) { return imageLoad(occluders, OCCLUDER_TEXELS * int(occluder) + texel); }

/// What the other instances have at a place of this one's volume, in texel numbers.
float depthOfOthers(vec3 texel, vec3 inverseSize) {
    float depth = 0.0;
    for (uint i = push.first; i < push.first + push.occluders; ++i) {
        const vec4 from = vec4(texel, 1.0);
        const vec3 place = vec3(dot(occluderTexel(i, 0), from), dot(occluderTexel(i, 1), from), dot(occluderTexel(i, 2), from));
        const vec3 size = occluderTexel(i, 4).xyz;
        const bool beside = any(lessThan(place.xy, vec2(0.0))) || any(greaterThan(place.xy, size.xy)) || place.z <= 0.5;
        const vec3 inside = clamp(place, vec3(0.5), size - 0.5);
        depth += beside ? 0.0 : textureLod(own, (occluderTexel(i, 3).xyz + inside) * inverseSize, 0.0).r;
    }
    return depth;
}

/// Whether there is density within a texel of those from `first` to `last` along a column: depths differ there.
bool isFilled(ivec3 first, int last) {
    bool filled = false;
    for (int i = 0; i < 9; ++i) {
        const ivec2 beside = clamp(first.xy + ivec2(i % 3, i / 3) - 1, ivec2(0), push.size.xy - 1);
        const float before = texelFetch(own, push.origin + ivec3(beside, max(first.z - 1, 0)), 0).r;
        const float behind = texelFetch(own, push.origin + ivec3(beside, min(last + 1, push.size.z - 1)), 0).r;
        filled = filled || before != behind;
    }
    return filled;
}

void main() {
    const ivec3 segments = ivec3(push.size.xy, (push.size.z + SHADOW_SEGMENT - 1) / SHADOW_SEGMENT);
    const uint number = linearInvocation(64u);
    if (number >= uint(segments.x) * uint(segments.y) * uint(segments.z)) return;
    const ivec3 first = cellNumbered(number, segments) * ivec3(1, 1, SHADOW_SEGMENT);
    const int last = min(first.z + SHADOW_SEGMENT, push.size.z) - 1;
    const vec3 inverseSize = 1.0 / vec3(textureSize(own, 0));
    // depths grow along the light: what is the same at both ends is the same between them
    const float begin = depthOfOthers(vec3(first), inverseSize);
    const float end = depthOfOthers(vec3(first.xy, last), inverseSize);
    const bool between = end - begin > INTERPOLATED && isFilled(first, last);
    const float step = (end - begin) / float(max(last - first.z, 1));
    int z = first.z;
    while (z <= last) {
        float others = begin;
        if (between) others = depthOfOthers(vec3(first.xy, z), inverseSize);
        const int until = between ? z : last;
        while (z <= until) {
            const ivec3 texel = push.origin + ivec3(first.xy, z);
            const float added = between ? others : begin + step * float(z - first.z);
            imageStore(together, texel, vec4(min(texelFetch(own, texel, 0).r + added, DARK)));
            ++z;
        }
    }
}
