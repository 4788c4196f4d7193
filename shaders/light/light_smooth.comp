#version 460
#extension GL_GOOGLE_include_directive : require
// The light field in each cell: what the cells around it have, each at the middle of its mass, smoothed with (¼, ½, ¼) along
// each axis about a plane through them (moving least squares: Lancaster and Salkauskas 1981). So the outermost cells have the
// light of their own depth, not of what lies behind them, and the empty cells beside them what it falls to beyond the surface.
#include "shared/draw.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly image3D cells;  // with a ring of empty ones
layout(binding = 1, rg32f) uniform readonly image3D trust;  // own share, sharpness
layout(binding = 2) uniform writeonly image3D lightField;
layout(binding = 3, scalar) readonly buffer LitCells { uint litCells[]; };
layout(binding = 4, rgba8) uniform readonly image3D massCentres;  // from the lower corner [cells]
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

/// Added to the variance of the places [cells²], so that slopes are small that few cells tell, and those that are noise: by
/// how sharp the light may be (light_counts.comp).
const float LEAST_RIDGE = 0.02, RIDGE = 8.0;
/// Part of the mean that a plane leaves everywhere.
const float LEAST = 0.2;

void main() {
    const uint entry = linearInvocation(64u);
    if (entry >= push.lit) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    const vec4 own = imageLoad(cells, cell + 1);
    const int reach = own.a > 0.0 ? 1 : 2;
    float weights = 0.0, sharpness = 0.0;
    vec3 light = vec3(0.0), place = vec3(0.0);
    mat3 places = mat3(0.0), slopes = mat3(0.0);  // Σ place placeᵀ, Σ light placeᵀ
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const ivec3 by = ivec3(x, y, z);
                const ivec3 other = cell + by;
                if (any(lessThan(other, ivec3(0))) || any(greaterThanEqual(other, push.grid))) continue;
                const vec4 there = imageLoad(cells, other + 1);
                if (there.a <= 0.0) continue;
                const float weight = float((reach + 1 - abs(x)) * (reach + 1 - abs(y)) * (reach + 1 - abs(z)));
                const vec3 at = vec3(by) + imageLoad(massCentres, other).xyz - 0.5;
                weights += weight;
                sharpness += imageLoad(trust, other).y;
                light += weight * there.rgb;
                place += weight * at;
                places += weight * outerProduct(at, at);
                slopes += weight * outerProduct(there.rgb, at);
            }
    if (weights <= 0.0) {
        imageStore(lightField, cell, vec4(0.0));
        return;
    }
    light /= weights;
    place /= weights;
    places = places / weights - outerProduct(place, place);
    slopes = slopes / weights - outerProduct(light, place);
    for (int i = 0; i < 3; ++i) places[i][i] += LEAST_RIDGE + RIDGE / max(sharpness, 1.0e-6);
    const mat3 slope = slopes * inverse(places);
    vec3 here = max(light - slope * place, LEAST * light);
    if (own.a > 0.0) {
        const vec3 counted = own.rgb - slope * (imageLoad(massCentres, cell).xyz - 0.5);
        here = mix(here, max(counted, LEAST * light), imageLoad(trust, cell).x);
    }
    imageStore(lightField, cell, vec4(here, 1.0));
}
