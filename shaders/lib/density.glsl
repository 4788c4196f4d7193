// Look-ups into the density volume, in voxel coordinates: voxel (i,j,k) has its value at (i+½, j+½, k+½).
#ifndef LUMULUS_LIB_DENSITY
#define LUMULUS_LIB_DENSITY

float densityAt(sampler3D density, vec3 voxel, vec3 inverseSize) { return texture(density, voxel * inverseSize).r; }

/// Value of one voxel; zero outside.
float densityOf(sampler3D density, ivec3 voxel, ivec3 size) {
    const bool inside = all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, size));
    return inside ? texelFetch(density, voxel, 0).r : 0.0;
}

#endif
