// Light of one view ray, put together from stretches of the cloud, nearest first. The includer declares lightField,
// shadowVolume, PhaseTable, SingleScatterH, SingleScatterK, `params`, `push` and the constants FORWARD_CUT, GREY, SUN and PHOTONS.
#ifndef LUMULUS_LIB_STRETCH
#define LUMULUS_LIB_STRETCH

#include "lib/sun_source.glsl"

/// Optical depth of the turned light beyond which a pixel is opaque.
const float OPAQUE = 8.0;

struct RayLight {
    vec3 cloud;
    float depth;     // true optical depth so far
    float distance;  // sum of weight · distance
    float weight;
    float front;
};

RayLight emptyRay() { return RayLight(vec3(0.0), 0.0, 0.0, 0.0, FAR_DEPTH); }

/// Of the colour that is seen deepest.
float leastExtinctionScale() {
    const vec3 extinctionScale = params.light.extinctionScale;
    return max(min(extinctionScale.x, min(extinctionScale.y, extinctionScale.z)), 0.01);
}

/// True optical depth at which nothing behind can be seen.
float opaqueDepth() { return OPAQUE / leastExtinctionScale(); }

/// In-scattered radiance per σs' (smooth between collectors); noise below zero is cut off last.
vec3 inScattered(vec3 voxel) {
    const vec4 light = textureLod(lightField, voxel * params.field.radianceScale, 0.0);
    return light.a > 0.0 ? max(light.rgb / light.a, 0.0) : vec3(0.0);
}

float depthToSun(vec3 voxel) {
    return textureLod(shadowVolume, params.field.voxelToShadow * voxel + params.field.shadowOffset, 0.0).r;
}

/// Where in a stretch (0 its near end, 1 its far end) the light seen comes from, as the quantile u of what it sends: in
/// the middle of thin ones, at the skin of thick ones.
float seenAt(float thickness, float u) {
    return thickness < 0.05 ? u : -log(1.0 - u * (1.0 - exp(-thickness))) / thickness;
}

/// Adds a stretch of optical thickness `thickness` between the distances near and far, lit as at `voxel`, the sun's
/// light through `tauSun`.
void addSegment(inout RayLight ray, SunView sun, float near, float far, float thickness, vec3 voxel, float tauSun) {
    if (PHOTONS) {
        // multiply scattered light: (1 − f) σs L against the turned medium's own extinction κ σt
        const vec3 turned = params.light.extinctionScale * thickness;
        const vec3 filled = mix((1.0 - expScaled(-turned)) / max(params.light.extinctionScale, 1.0e-6), vec3(thickness),
                                lessThan(turned, vec3(1.0e-3)));
        ray.cloud += params.light.albedo * params.light.scatterShare * inScattered(voxel) * filled *
                     expScaled(-params.light.extinctionScale * ray.depth);
    }
    if (SUN) ray.cloud += sunScattered(sun, params.light, tauSun, ray.depth, thickness);
    const float weight = exp(-ray.depth) * (1.0 - exp(-thickness));
    ray.distance += weight * 0.5 * (near + far);
    ray.weight += weight;
    if (thickness > 0.0) ray.front = min(ray.front, near);
    ray.depth += thickness;
}

/// A pixel that no ray has reached; `depth` holds Σ weight · distance until it is finished.
struct PixelSum {
    Pixel pixel;
    float weight;
};

PixelSum emptyPixel() {
    return PixelSum(Pixel(vec3(0.0), 0.0, 0.0, 0.0, FAR_DEPTH, vec3(0.0), vec2(0.0)), 0.0);
}

void addRay(inout PixelSum sum, RayLight ray, vec3 direction) {
    const float transmittance = exp(-ray.depth);
    const vec3 turned = exp(-params.light.extinctionScale * ray.depth);
    sum.pixel.cloud += ray.cloud;
    sum.pixel.radiance += ray.cloud + params.light.skyRadiance * turned;
    // what is drawn in the sun's disc is not spread over its neighbours
    if (push.what != DRAW_SPARSE && push.what != DRAW_REFINED) sum.pixel.radiance += discSeen(params.light, direction) * transmittance;
    sum.pixel.transmittance += transmittance;
    sum.pixel.alpha += 1.0 - (turned.x + turned.y + turned.z) / 3.0;
    sum.pixel.depth += ray.distance;
    sum.pixel.front = min(sum.pixel.front, ray.front);
    sum.weight += ray.weight;
}

/// The mean of `rays` rays.
Pixel finishedPixel(PixelSum sum, int rays) {
    const float share = 1.0 / float(rays);
    Pixel pixel = sum.pixel;
    pixel.cloud *= share;
    pixel.radiance *= share;
    pixel.transmittance *= share;
    pixel.alpha *= share;
    pixel.depth = sum.weight > 0.0 ? pixel.depth / sum.weight : FAR_DEPTH;
    return pixel;
}

#endif
