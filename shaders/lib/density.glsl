// Look-ups into the density volume, in voxel coordinates: voxel (i,j,k) has its value at (i+½, j+½, k+½).
#ifndef LUMULUS_LIB_DENSITY
#define LUMULUS_LIB_DENSITY

float densityAt(sampler3D density, vec3 voxel, vec3 inverseSize) { return texture(density, voxel * inverseSize).r; }

/// Value of one voxel; zero outside.
float densityOf(sampler3D density, ivec3 voxel, ivec3 size) {
    const bool inside = all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, size));
    return inside ? texelFetch(density, voxel, 0).r : 0.0;
}

/// The same in an atlas, where the volume begins at `origin`.
float densityOf(sampler3D density, ivec3 voxel, ivec3 size, ivec3 origin) {
    const bool inside = all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, size));
    return inside ? texelFetch(density, origin + voxel, 0).r : 0.0;
}

/// One of the eight voxels around a place, each with its weight in the interpolation between them: one look-up then has
/// the mean of the interpolated density. That is exact where only the mean counts, as for whether a collision is real.
ivec3 voxelNear(vec3 voxel, vec2 u) {
    const float fine = 4096.0 * u.x;  // of 24 bits, half for y and half for z
    return ivec3(floor(voxel - 0.5 + vec3(u.y, (floor(fine) + 0.5) / 4096.0, fract(fine))));
}

/// Exact integral of the trilinear field over one voxel's cube: in each axis (⅛, ¾, ⅛), which two taps at ±¼ give;
/// after it the moment about the voxel's lower corner.
vec4 voxelMass(sampler3D density, ivec3 voxel, vec3 inverseSize) {
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 offset = 0.5 * vec3(corner & 1, (corner >> 1) & 1, corner >> 2) - 0.25;
        sum += vec4(1.0, 0.5 + offset) * densityAt(density, vec3(voxel) + 0.5 + offset, inverseSize);
    }
    return 0.125 * sum;
}

#endif
