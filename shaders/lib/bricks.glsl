// Look-ups into a density field that is stored in bricks (vdb/sparse_volume.h): an index finds the brick's slot in a pool of
// slots, each with 9³ texels, so that interpolation stays within it.
#ifndef LUMULUS_LIB_BRICKS
#define LUMULUS_LIB_BRICKS

/// Whether the density is stored in bricks; `density` is then their pool.
layout(constant_id = 15) const bool SPARSE = false;
/// The index: for each 4³ bricks of the box the place of their entries, counted from the field's first texel, then entries
/// of 4³ bricks each. Texels follow each other along rows. Where the density is dense any image stands here.
layout(binding = 15) uniform usampler3D bricks;

const int BRICK_EDGE = 8, SLOT_EDGE = 9, NODE_EDGE = 4;

ivec3 indexTexel(uint number) { return ivec3(number & 1023u, (number >> 10) & 1023u, number >> 20); }

/// Number of the index's texel for a brick; `first` is that of the field.
uint brickEntry(ivec3 brick, ivec3 size, uint first) {
    const ivec3 roots = (size + BRICK_EDGE * NODE_EDGE - 1) / (BRICK_EDGE * NODE_EDGE);
    const ivec3 root = brick / NODE_EDGE, within = brick % NODE_EDGE;
    const uint node = texelFetch(bricks, indexTexel(first + uint((root.z * roots.y + root.y) * roots.x + root.x)), 0).x;
    return first + node + uint((within.z * NODE_EDGE + within.y) * NODE_EDGE + within.x);
}

/// Where a place lies in the pool.
struct BrickPlace {
    vec3 local;   // in the slot, 0 to 8 texels from its first one
    ivec3 slot;   // its first texel
    vec2 range;   // density where the texel is 0, and what it is more where the texel is 1
};

/// `centred`: voxel coordinates − ½, so that whole numbers are middles of voxels; within the volume.
BrickPlace brickPlace(vec3 centred, ivec3 size, uint first) {
    centred = clamp(centred, vec3(0.0), vec3(size) - 1.0);
    const ivec3 brick = ivec3(centred) / BRICK_EDGE;
    const uvec2 entry = texelFetch(bricks, indexTexel(brickEntry(brick, size, first)), 0).xy;
    const int level = int(entry.x >> 28);
    const ivec3 corner = ((brick >> level) << level) * BRICK_EDGE;
    BrickPlace place;
    place.local = (centred - vec3(corner)) * exp2(-float(level));
    place.slot = ivec3(entry.x & 511u, (entry.x >> 9) & 511u, (entry.x >> 18) & 1023u) * SLOT_EDGE;
    place.range = unpackHalf2x16(entry.y);
    return place;
}

float brickDensity(sampler3D pool, vec3 voxel, ivec3 size, uint first) {
    const BrickPlace place = brickPlace(voxel - 0.5, size, first);
    const vec3 at = (vec3(place.slot) + 0.5 + place.local) / vec3(textureSize(pool, 0));
    return place.range.x + place.range.y * texture(pool, at).r;
}

/// Of one texel around a place, each by its weight in the interpolation between them; u in [0,1)³.
float brickDensityNear(sampler3D pool, vec3 voxel, vec3 u, ivec3 size, uint first) {
    const BrickPlace place = brickPlace(voxel - 0.5, size, first);
    const ivec3 texel = min(ivec3(place.local + u), ivec3(BRICK_EDGE));
    return place.range.x + place.range.y * texelFetch(pool, place.slot + texel, 0).r;
}

#endif
