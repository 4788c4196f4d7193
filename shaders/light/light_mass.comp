#version 460
#extension GL_GOOGLE_include_directive : require
// Mass of each cell of the light field, as photons meet it: the integral of the interpolated density [voxels]; and where in the
// cell its middle is.
#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform writeonly image3D cellMass;
layout(binding = 2, r32f) uniform readonly image3D majorants;  // negative or zero: empty, with its interpolation
layout(binding = 3) uniform writeonly image3D massCentres;  // from its lower corner, in edges of a cell
layout(push_constant, scalar) uniform Push { LightMassPush push; };

/// Mass between two corners, and its moment about `origin`.
vec4 massOf(ivec3 lower, ivec3 upper, ivec3 origin, vec3 inverseSize) {
    vec4 sum = vec4(0.0);
    for (int z = lower.z; z < upper.z; ++z)
        for (int y = lower.y; y < upper.y; ++y)
            for (int x = lower.x; x < upper.x; ++x) {
                const vec4 voxel = voxelMass(density, ivec3(x, y, z), inverseSize);
                sum += vec4(voxel.x, voxel.yzw + voxel.x * vec3(ivec3(x, y, z) - origin));
            }
    return sum;
}

void store(ivec3 cell, vec4 mass) {
    imageStore(cellMass, cell, vec4(mass.x));
    const vec3 middle = mass.x > 0.0 ? mass.yzw / (mass.x * float(push.edge)) : vec3(0.5);
    imageStore(massCentres, cell, vec4(middle, 0.0));
}

/// Whether the majorants of all that lies between two corners are zero.
bool isEmpty(ivec3 lower, ivec3 upper) {
    const ivec3 first = ivec3(vec3(lower) * push.perMajorant);
    const ivec3 last = min(ivec3(vec3(upper) * push.perMajorant), push.majorantCells - 1);
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                if (imageLoad(majorants, ivec3(x, y, z)).r > 0.0) return false;
    return true;
}

void main() {
    const uint index = linearInvocation(64u);
    if (index >= uint(push.grid.x) * uint(push.grid.y) * uint(push.grid.z)) return;
    const ivec3 cell = cellNumbered(index, push.grid);
    const ivec3 lower = push.edge * cell;
    const ivec3 upper = min(lower + push.edge, push.size);
    const vec3 inverseSize = 1.0 / vec3(push.size);
    if (!SPARSE) {
        store(cell, isEmpty(lower, upper) ? vec4(0.0) : massOf(lower, upper, lower, inverseSize));
        return;
    }
    vec4 sum = vec4(0.0);
    const ivec3 first = lower / BRICK_EDGE, last = (upper - 1) / BRICK_EDGE;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const ivec3 corner = BRICK_EDGE * ivec3(x, y, z);
                if (!isEmptyAround(ivec3(x, y, z), push.size))
                    sum += massOf(max(corner, lower), min(corner + BRICK_EDGE, upper), lower, inverseSize);
            }
    store(cell, sum);
}
