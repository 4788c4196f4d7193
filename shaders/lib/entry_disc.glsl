// Where photons begin round several clouds: a cloud by its share, a point of the disc that its ellipsoid shows to the light.
// A line may go through several discs, and each of them may have chosen it: the weight is one over the sum of their densities,
// so that the union of all is met evenly, whatever the shares. Any direction will do.
#ifndef LUMULUS_LIB_ENTRY_DISC
#define LUMULUS_LIB_ENTRY_DISC

#include "shared/world.h"

layout(binding = 19, rgba32f) uniform readonly imageBuffer entryDiscs;

/// Rows of a matrix, and a place in the fourth column.
struct Rows {
    vec4 x, y, z;
};

Rows entryRows(int disc, int first) {
    const int place = ENTRY_TEXELS * disc + first;
    return Rows(imageLoad(entryDiscs, place), imageLoad(entryDiscs, place + 1), imageLoad(entryDiscs, place + 2));
}

vec3 applyRows(Rows rows, vec4 to) { return vec3(dot(rows.x, to), dot(rows.y, to), dot(rows.z, to)); }

/// The disc that a photon begins on, by shares; u in [0,1).
int chooseDisc(uint discs, float u) {
    const float place = u * float(discs);
    const int disc = min(int(place), int(discs) - 1);
    const vec4 entry = imageLoad(entryDiscs, ENTRY_TEXELS * disc + 7);
    return place - float(disc) < entry.z ? disc : int(entry.w);
}

/// A point on a disc across the direction, uniform: metres from the corner of the grid.
vec3 pointOnDisc(int disc, vec3 direction, vec2 u) {
    const vec3 along = normalize(applyRows(entryRows(disc, 1), vec4(direction, 0.0)));
    const vec3 aside = normalize(abs(along.y) < 0.9 ? vec3(along.z, 0.0, -along.x) : vec3(0.0, -along.z, along.y));
    const float radius = sqrt(u.x), angle = 6.28318531 * u.y;
    const vec3 point = radius * (cos(angle) * aside + sin(angle) * cross(along, aside));
    return applyRows(entryRows(disc, 4), vec4(point, 1.0));
}

/// Where light of this direction enters the union of the discs [m from the corner of the grid], and the area that a photon
/// there stands for [m²].
vec3 entryPoint(uint discs, vec3 direction, vec3 u, out float area) {
    const vec3 point = pointOnDisc(chooseDisc(discs, u.x), direction, u.yz);
    float density = 0.0, nearest = 3.4e38;
    for (int disc = 0; disc < int(discs); ++disc) {
        const vec4 sphere = imageLoad(entryDiscs, ENTRY_TEXELS * disc);
        const vec3 away = sphere.xyz - point, beside = away - dot(away, direction) * direction;
        if (dot(beside, beside) > sphere.w * sphere.w) continue;
        const Rows rows = entryRows(disc, 1);
        const vec3 place = applyRows(rows, vec4(point, 1.0)), along = applyRows(rows, vec4(direction, 0.0));
        const float squared = dot(along, along), middle = -dot(place, along) / squared;
        const vec3 closest = place + middle * along;
        const float inside = 1.0 - dot(closest, closest);
        if (inside < -1.0e-5) continue;
        const vec4 entry = imageLoad(entryDiscs, ENTRY_TEXELS * disc + 7);
        density += entry.y * inversesqrt(squared) / entry.x;
        nearest = min(nearest, middle - sqrt(max(inside, 0.0) / squared));
    }
    area = density > 0.0 ? 1.0 / density : 0.0;
    return point + (density > 0.0 ? nearest : 0.0) * direction;
}

#endif
