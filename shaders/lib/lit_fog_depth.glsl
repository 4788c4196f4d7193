// Optical depths of fog along a ray. The includer declares Media, `params` and the medium `first`, held in registers.
#ifndef LUMULUS_LIB_LIT_FOG_DEPTH
#define LUMULUS_LIB_LIT_FOG_DEPTH

#include "lib/lit_fog_ray.glsl"

/// What lies on a path. One place calls depthTo() for all distances of a ray that are known beforehand, and one for those of
/// steps: each call is compiled into the shader anew.
struct Depth {
    vec3 extinction;  // optical depth, as those below
    vec3 peak;        // of the peaks of the fog's scattering
};

void addDepth(inout Depth depth, FogMedium medium, float path, bool ofFog) {
    depth.extinction += (medium.scattering + medium.absorption) * path;
    if (!ofFog) return;
    depth.peak += peakShare(medium.g) * medium.scattering * path;
}

/// Of the first `distance_` metres, of the truncated media; the peaks are those of the fog alone.
Depth depthTo(Ray ray, float distance_) {
    Depth depth = Depth(vec3(0.0), vec3(0.0));
    FogMedium medium = first;
    for (int i = 0; i < params.media + params.airMedia; ++i) {
        if (i > 0) medium = media[i];
        const float path = densityIntegral(medium, ray.origin, ray.direction, distance_, FAR_DEPTH);
        addDepth(depth, medium, path, i < params.media);
    }
    return depth;
}

/// Where a part of an optical thickness ends, as a share of the way, if it were even.
float shareOfWay(float thickness, float u) {
    return thickness < 0.05 ? u : -log(1.0 - u * (1.0 - exp(-thickness))) / thickness;
}

#endif
