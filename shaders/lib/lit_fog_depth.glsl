// Optical depths of fog along a ray. The includer declares Media, `params` and the medium `first`, held in registers.
#ifndef LUMULUS_LIB_LIT_FOG_DEPTH
#define LUMULUS_LIB_LIT_FOG_DEPTH

#include "lib/lit_fog_ray.glsl"

/// What lies on a path. One place calls depthTo() for all distances of a ray that are known beforehand, and one for those of
/// steps: each call is compiled into the shader anew.
struct Depth {
    vec3 extinction;  // optical depth, as those below
    vec3 scattering;
    vec3 similar;     // (1 − g) scattering
};

void addDepth(inout Depth depth, FogMedium medium, float path, bool ofFog) {
    depth.extinction += (medium.scattering + medium.absorption) * path;
    if (!ofFog) return;
    depth.scattering += medium.scattering * path;
    depth.similar += (1.0 - medium.g) * medium.scattering * path;
}

/// Of the first `distance_` metres, of the truncated media; the scattering is that of the fog alone.
Depth depthTo(Ray ray, float distance_) {
    Depth depth = Depth(vec3(0.0), vec3(0.0), vec3(0.0));
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

/// Of light that is scattered on a path, the share that goes on to the eye, over what the filter takes for it: some is
/// scattered back. Diffuse transmittance of slabs by doubling (scripts/study/layers.py).
vec3 forwardShare(Depth depth) {
    const vec3 straight = exp(-depth.scattering), scatters = max(1.0 - straight, 1.0e-6);
    return clamp((1.0 / (1.0 + 0.66 * depth.similar) - straight) / scatters, vec3(0.0), vec3(1.0));
}

#endif
