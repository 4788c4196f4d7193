// Optical depth towards the sun where the light falls within a voxel, which the grid of a shadow volume does not resolve. The
// includer has what lib/ray_segment.glsl asks for and the constant THICK.
#ifndef LUMULUS_LIB_NEAR_SUN
#define LUMULUS_LIB_NEAR_SUN

/// Voxels towards the sun that are gone through in samples, the denser the nearer, and their number.
const float NEAR_SUN_REACH = 8.0;
const int NEAR_SUN_SAMPLES = 24;
/// Optical depth that hides what the shadow volume has wrong.
const float NEAR_SUN_HIDDEN = 4.0;

/// Optical depth to the sun of a place that is seen through `hidden`.
float depthToSunNear(InstanceParams instance, vec3 voxel, float hidden) {
    if (!THICK || hidden > NEAR_SUN_HIDDEN) return depthToSun(instance, voxel);
    const vec3 velocity = instance.worldToVoxel * -params.light.sunTravel;
    const float voxels = length(velocity);  // a metre
    const vec3 towards = velocity / voxels;
    float sum = 0.0, before = 0.0;
    for (int i = 1; i <= NEAR_SUN_SAMPLES; ++i) {
        const float share = float(i) / float(NEAR_SUN_SAMPLES);
        const float after = NEAR_SUN_REACH * share * share;
        sum += (after - before) * densityIn(instance, density, voxel + 0.5 * (before + after) * towards);
        before = after;
    }
    return sum * instance.extinction / voxels + depthToSun(instance, voxel + NEAR_SUN_REACH * towards);
}

#endif
