// Where photons begin round several clouds: a cloud by its share, a point of the disc that its ellipsoid shows to the light.
// A line may go through several discs, and each of them may have chosen it: the weight is one over the sum of their densities,
// so that the union of all is met evenly, whatever the shares. Any direction will do. A coarse grid has lists of the discs in
// each cell (photon/entry_grid.h): of many clouds only those along the line are asked.
#ifndef LUMULUS_LIB_ENTRY_DISC
#define LUMULUS_LIB_ENTRY_DISC

#include "shared/world.h"
#include "lib/traversal.glsl"

layout(binding = 19, rgba32f) uniform readonly imageBuffer entryDiscs;
layout(binding = 30, r32ui) uniform readonly uimageBuffer entryLists;

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

/// The discs on a line, and where it enters the first of them.
struct LineDiscs {
    float density;  // sum of the probabilities that a photon begins on this line [1/m²]
    float nearest;  // [m] along it
};

/// Adds a disc, if the line comes nearest to its middle between two distances: whatever cells of the grid it is in, it then
/// counts in one of them.
void addDisc(inout LineDiscs found, int disc, vec3 point, vec3 direction, vec2 between) {
    const Rows rows = entryRows(disc, 1);
    const vec3 place = applyRows(rows, vec4(point, 1.0)), along = applyRows(rows, vec4(direction, 0.0));
    const float squared = dot(along, along), middle = -dot(place, along) / squared;
    const vec3 closest = place + middle * along;
    const float inside = 1.0 - dot(closest, closest);
    if (inside < -1.0e-5 || middle < between.x || middle >= between.y) return;
    const vec4 entry = imageLoad(entryDiscs, ENTRY_TEXELS * disc + 7);
    found.density += entry.y * inversesqrt(squared) / entry.x;
    found.nearest = min(found.nearest, middle - sqrt(max(inside, 0.0) / squared));
}

/// Where light of this direction enters the union of the discs [m from the corner of the grid], and the area that a photon
/// there stands for [m²].
vec3 entryPoint(MergedGridParams grid, vec3 direction, vec3 u, out float area) {
    const vec3 point = pointOnDisc(chooseDisc(grid.instances, u.x), direction, u.yz);
    const Line line = lineFrom(point / grid.entryEdge, direction / grid.entryEdge);
    const vec3 size = vec3(grid.entryCells);
    const vec3 a = -line.start * line.inverse, b = (size - line.start) * line.inverse;
    const vec3 low = min(a, b);
    const float begin = max(low.x, max(low.y, low.z));
    ivec3 cell = clamp(ivec3(floor(line.start + begin * line.velocity)), ivec3(0), grid.entryCells - 1);
    LineDiscs found = LineDiscs(0.0, 3.4e38);
    vec2 between = vec2(-3.4e38, 0.0);
    bool within = true;
    while (within) {
        const int number = (cell.z * grid.entryCells.y + cell.y) * grid.entryCells.x + cell.x;
        const int last = int(imageLoad(entryLists, number + 1).r);
        between.y = leaveCells(line, cell, 0, vec3(1.0));
        for (int entry = int(imageLoad(entryLists, number).r); entry < last; ++entry)
            addDisc(found, int(imageLoad(entryLists, entry).r), point, direction, between);
        between.x = between.y;
        within = all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, grid.entryCells));
    }
    area = found.density > 0.0 ? 1.0 / found.density : 0.0;
    return point + (found.density > 0.0 ? found.nearest : 0.0) * direction;
}

#endif
