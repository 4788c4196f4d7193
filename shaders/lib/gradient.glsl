// Gradient magnitude by central differences (Elek 2011, eq. 5.1, with its sign mended), ε = one voxel.
#ifndef LUMULUS_LIB_GRADIENT
#define LUMULUS_LIB_GRADIENT

#include "lib/density.glsl"

/// At a voxel's centre, per metre.
float gradientOf(sampler3D density, ivec3 voxel, ivec3 size, mat3 toMetres) {
    const vec3 difference = vec3(densityOf(density, voxel + ivec3(1, 0, 0), size) - densityOf(density, voxel - ivec3(1, 0, 0), size),
                                 densityOf(density, voxel + ivec3(0, 1, 0), size) - densityOf(density, voxel - ivec3(0, 1, 0), size),
                                 densityOf(density, voxel + ivec3(0, 0, 1), size) - densityOf(density, voxel - ivec3(0, 0, 1), size));
    return length(toMetres * (0.5 * difference));
}

/// At any point. The difference of a trilinear field over whole voxels is the trilinear interpolation of the gradients
/// at the voxels around, so its length never exceeds the largest of theirs: the bound of the rejection sampling.
float gradientAt(sampler3D density, vec3 voxel, vec3 inverseSize, mat3 toMetres) {
    const vec3 difference =
        vec3(densityAt(density, voxel + vec3(1, 0, 0), inverseSize) - densityAt(density, voxel - vec3(1, 0, 0), inverseSize),
             densityAt(density, voxel + vec3(0, 1, 0), inverseSize) - densityAt(density, voxel - vec3(0, 1, 0), inverseSize),
             densityAt(density, voxel + vec3(0, 0, 1), inverseSize) - densityAt(density, voxel - vec3(0, 0, 1), inverseSize));
    return length(toMetres * (0.5 * difference));
}

#endif
