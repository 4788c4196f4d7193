// What clouds leave of the sun's light in the air around them: a ray towards the sun is looked up where it enters the box of
// the cloud that it meets first, whose shadow volume has all that stands before it. The includer declares `params` and MANY.
#ifndef LUMULUS_LIB_CLOUD_SHADOW
#define LUMULUS_LIB_CLOUD_SHADOW

#include "shared/lit_fog.h"
#include "lib/traversal.glsl"

layout(binding = 8, rgba32f) readonly uniform imageBuffer casters;
layout(binding = 9) uniform sampler3D shadowVolume;

/// Of three rows of texels: of a place (w = 1), or of a direction.
vec3 casterRows(int first, vec4 of) {
    return vec3(dot(imageLoad(casters, first), of), dot(imageLoad(casters, first + 1), of),
                dot(imageLoad(casters, first + 2), of));
}

/// Optical depth of the truncated media towards the sun from a voxel of a cloud.
vec3 casterDepth(int first, vec3 voxel) {
    vec3 place = casterRows(first + 4, vec4(voxel, 1.0));
    const vec3 scale = imageLoad(casters, first + 9).rgb;
    if (MANY) {
        const vec3 size = imageLoad(casters, first + 8).xyz;
        place = (imageLoad(casters, first + 7).xyz + clamp(place * size, vec3(0.5), size - 0.5)) * params.inverseShadows;
    }
    return scale * textureLod(shadowVolume, place, 0.0).r;
}

/// Share of the sun's light that the clouds let through to a place.
vec3 throughClouds(vec3 point) {
    float nearest = 3.4e38;
    int first = -1;
    vec3 entry = vec3(0.0);
    for (int caster = 0; caster < params.casters; ++caster) {
        const int at = CASTER_TEXELS * caster;
        const vec3 start = casterRows(at, vec4(point, 1.0));
        const vec3 velocity = casterRows(at, vec4(params.toSun, 0.0)), size = imageLoad(casters, at + 3).xyz;
        const Line line = lineFrom(start, velocity);
        const vec2 inside = clipToVolume(line, size);
        if (inside.x >= inside.y || inside.x >= nearest) continue;
        nearest = inside.x;
        first = at;
        entry = line.start + line.velocity * inside.x;
    }
    return first < 0 ? vec3(1.0) : exp(-casterDepth(first, entry));
}

/// Of a ray: the part in which the shadow of a cloud may lie, by the faces that the sun sees and by the outline of the box
/// against the sun.
vec2 shadowRange(int first, vec3 origin, vec3 direction) {
    const vec3 start = casterRows(first, vec4(origin, 1.0)), velocity = casterRows(first, vec4(direction, 0.0));
    const vec3 sun = casterRows(first, vec4(params.toSun, 0.0)), size = imageLoad(casters, first + 3).xyz;
    vec2 range = vec2(0.0, 3.4e38);
    for (int axis = 0; axis < 3; ++axis) {
        vec3 along = vec3(0.0);
        along[axis] = 1.0;
        const vec3 normal = cross(along, sun);
        const float low = dot(min(normal, 0.0), size), high = dot(max(normal, 0.0), size);
        float from = low - dot(normal, start), to = high - dot(normal, start), rate = dot(normal, velocity);
        if (abs(rate) < 1.0e-12) {
            if (from > 0.0 || to < 0.0) return vec2(0.0);
        } else {
            range.x = max(range.x, min(from / rate, to / rate));
            range.y = min(range.y, max(from / rate, to / rate));
        }
        if (sun[axis] == 0.0) continue;
        // below the face that the sun sees
        const float beyond = sun[axis] > 0.0 ? size[axis] - start[axis] : start[axis];
        rate = sun[axis] > 0.0 ? velocity[axis] : -velocity[axis];
        if (abs(rate) < 1.0e-12) {
            if (beyond < 0.0) return vec2(0.0);
        } else if (rate > 0.0) {
            range.y = min(range.y, beyond / rate);
        } else {
            range.x = max(range.x, beyond / rate);
        }
    }
    return range;
}

#endif
