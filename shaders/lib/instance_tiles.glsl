// The instances that a pixel may see: each tile of pixels has a list of them, nearest first, so that a ray asks only those. The
// includer declares `params` and MANY; where there is one instance nothing of this is read.
#ifndef LUMULUS_LIB_INSTANCE_TILES
#define LUMULUS_LIB_INSTANCE_TILES

#include "lib/instances.glsl"

layout(binding = 10, scalar) readonly buffer TileOffsets { uint tileOffsets[]; };
layout(binding = 11, rg32ui) readonly uniform uimageBuffer tileLists;  // instance, where it begins at the nearest
// As texels: their loads are by vectors on lavapipe, those from buffers by lanes.
layout(binding = 14, rgba32f) readonly uniform imageBuffer instancePlaces;

/// Entries of the lists from `first` to `last`.
struct InstanceRange {
    int first, last;
};

InstanceRange instancesOf(ivec2 pixel) {
    const int tile = (pixel.y / TILE_EDGE) * params.tilesAcross + pixel.x / TILE_EDGE;
    return InstanceRange(int(tileOffsets[tile]), int(tileOffsets[tile + 1]));
}

/// An entry of a list: no ray meets it, or those after it, before a distance [m].
struct Listed {
    int instance;
    float nearest;
};

Listed listedInstance(int entry) {
    const uvec2 texel = imageLoad(tileLists, entry).rg;
    return Listed(int(texel.x), uintBitsToFloat(texel.y));
}

/// Distances between which a ray is in a listed instance, and the voxel's length there.
vec2 insideOf(int instance, vec3 origin, vec3 direction, out float voxelLength) {
    const int place = INSTANCE_TEXELS * instance;
    const vec4 x = imageLoad(instancePlaces, place), y = imageLoad(instancePlaces, place + 1),
               z = imageLoad(instancePlaces, place + 2), size = imageLoad(instancePlaces, place + 3);
    voxelLength = size.w;
    const vec4 from = vec4(origin, 1.0);
    return clipToVolume(lineFrom(vec3(dot(x, from), dot(y, from), dot(z, from)),
                                 vec3(dot(x.xyz, direction), dot(y.xyz, direction), dot(z.xyz, direction))),
                        size.xyz);
}

/// Voxels of the shorter one that a ray goes through before it looks for what it meets in another instance that it is in too.
const float SHARED_SEGMENT = 2.0;

/// The end of the segment that begins at a distance: the next distance at which an instance is entered or left, or a little
/// way where the line is in several. Negative: nothing is met from there on. Leaves out of the range what comes first in it
/// and lies behind.
float segmentEnd(inout InstanceRange range, vec3 origin, vec3 direction, float begin) {
    float end = 3.4e38, shortest = 3.4e38;
    int within = 0;
    for (int entry = range.first; entry < range.last; ++entry) {
        const Listed listed = listedInstance(entry);
        if (listed.nearest > end) break;
        float voxelLength;
        const vec2 inside = insideOf(listed.instance, origin, direction, voxelLength);
        if (inside.x >= inside.y || inside.y <= begin) {
            if (entry == range.first) ++range.first;
            continue;
        }
        if (inside.x > begin) {
            end = min(end, inside.x);
        } else {
            ++within;
            end = min(end, inside.y);
            shortest = min(shortest, SHARED_SEGMENT * voxelLength);
        }
    }
    if (within > 1) end = min(end, max(begin + shortest, begin * (1.0 + 1.0e-6)));
    return end < 3.0e38 ? end : -1.0;
}

#endif
