// Light of one view ray, put together from segments that lie in one instance each, nearest first. The includer declares
// lightField, shadowVolume, PhaseTable, singleScatterH, singleScatterK, `params`, `push` and the constants FORWARD_CUT, GREY,
// SUN, PHOTONS, AIR and MANY; sunColours with AIR.
#ifndef LUMULUS_LIB_RAY_SEGMENT
#define LUMULUS_LIB_RAY_SEGMENT

#include "lib/instances.glsl"
#include "lib/sky_return.glsl"
#include "lib/sun_source.glsl"

/// Optical depth of the truncated medium beyond which a pixel is opaque.
const float OPAQUE = 8.0;

struct RayLight {
    vec3 cloud;
    float depth;     // true optical depth so far
    vec3 truncated;  // optical depth of the truncated media so far; only with MANY
    float distance;  // sum of weight · distance
    float weight;
    float front;
};

RayLight emptyRay() { return RayLight(vec3(0.0), 0.0, vec3(0.0), 0.0, 0.0, FAR_DEPTH); }

/// Of the colour that is seen deepest.
float leastExtinctionScale(InstanceParams instance) {
    const vec3 scale = instance.extinctionScale;
    return max(min(scale.x, min(scale.y, scale.z)), 0.01);
}

/// True optical depth at which nothing behind can be seen.
float opaqueDepth(InstanceParams instance) { return OPAQUE / leastExtinctionScale(instance); }

/// The same with several media: whether anything behind can be seen.
bool isOpaque(RayLight ray) { return min(ray.truncated.x, min(ray.truncated.y, ray.truncated.z)) >= OPAQUE; }

/// In-scattered radiance per σs' (smooth between collectors); noise below zero is cut off last.
vec3 inScattered(InstanceParams instance, vec3 voxel) {
    vec3 place = voxel * instance.radianceScale;
    if (MANY)
        place = (instance.lightOrigin + clamp(place * instance.lightSize, vec3(0.5), instance.lightSize - 0.5)) *
                params.atlas.light;
    const vec4 light = textureLod(lightField, place, 0.0);
    return light.a > 0.0 ? max(light.rgb / light.a, 0.0) : vec3(0.0);
}

/// Optical depth towards the sun, by the shadow volume of the instance.
float depthToSun(InstanceParams instance, vec3 voxel) {
    vec3 place = instance.voxelToShadow * voxel + instance.shadowOffset;
    if (MANY)
        place = (instance.shadowOrigin + clamp(place * instance.shadowSize, vec3(0.5), instance.shadowSize - 0.5)) *
                params.atlas.shadow;
    return textureLod(shadowVolume, place, 0.0).r;
}

/// The sun's light at a place of an instance, against the most that it has anywhere in it.
vec3 sunColour(InstanceParams instance, vec3 voxel) {
    const vec2 place = airPlace(instance.air, voxel) * vec2(SUN_COLOUR_COLUMNS - 1, SUN_COLOUR_ROWS - 1) + 0.5;
    return textureLod(sunColours, (instance.airTexel + place) / vec2(textureSize(sunColours, 0)), 0.0).rgb;
}

/// Where in a segment (0 its near end, 1 its far end) the light seen comes from, as the quantile u of what it sends: in
/// the middle of thin ones, at the skin of thick ones.
float seenAt(float thickness, float u) {
    return thickness < 0.05 ? u : -log(1.0 - u * (1.0 - exp(-thickness))) / thickness;
}

/// Adds a segment of optical thickness `thickness` between the distances near and far, lit as at `voxel`, the sun's
/// light through `tauSun`.
void addSegment(inout RayLight ray, InstanceParams instance, SunView sun, float near, float far, float thickness, vec3 voxel,
                float tauSun) {
    if (PHOTONS) {
        // multiply scattered light: (1 − f) σs L against the truncated medium's own extinction κ σt
        const vec3 scaled = instance.extinctionScale * thickness;
        const vec3 filled = mix((1.0 - expScaled(-scaled)) / max(instance.extinctionScale, 1.0e-6), vec3(thickness),
                                lessThan(scaled, vec3(1.0e-3)));
        vec3 before = -instance.extinctionScale * ray.depth;
        if (MANY) before = -ray.truncated;
        ray.cloud += instance.albedo * instance.scatterShare * inScattered(instance, voxel) * filled * expScaled(before);
    }
    if (SUN) {
        vec3 scattered = sunScattered(sun, instance, tauSun, ray.depth, thickness);
        if (AIR) scattered *= sunColour(instance, voxel);
        ray.cloud += scattered;
    }
    const float weight = exp(-ray.depth) * (1.0 - exp(-thickness));
    ray.distance += weight * 0.5 * (near + far);
    ray.weight += weight;
    if (thickness > 0.0) ray.front = min(ray.front, near);
    ray.depth += thickness;
    if (MANY) ray.truncated += instance.extinctionScale * thickness;
}

/// A pixel that no ray has reached; `depth` holds Σ weight · distance until it is finished.
struct PixelSum {
    Pixel pixel;
    float weight;
};

PixelSum emptyPixel() {
    return PixelSum(Pixel(vec3(0.0), 0.0, 0.0, 0.0, FAR_DEPTH, vec3(0.0), vec2(0.0)), 0.0);
}

/// Share that is seen of what is behind.
vec3 seenBehind(RayLight ray) {
    if (MANY) return exp(-ray.truncated);
    return exp(-onlyInstance.extinctionScale * ray.depth);
}

/// Adds a ray that ends at a mesh, whose light belongs to the pixel as that of the cloud does.
void addRayToMesh(inout PixelSum sum, RayLight ray, float distance, vec3 radiance) {
    const float transmittance = exp(-ray.depth);
    const vec3 light = ray.cloud + radiance * seenBehind(ray);
    sum.pixel.cloud += light;
    sum.pixel.radiance += light;
    sum.pixel.alpha += 1.0;
    sum.pixel.depth += ray.distance + transmittance * distance;
    sum.pixel.front = min(sum.pixel.front, min(ray.front, distance));
    sum.weight += ray.weight + transmittance;
}

void addRay(inout PixelSum sum, RayLight ray, vec3 direction) {
    const float transmittance = exp(-ray.depth);
    const vec3 seen = seenBehind(ray);
    if (SKY_RETURN) ray.cloud = max(ray.cloud + returnedSky(direction, ray.depth), 0.0);
    sum.pixel.cloud += ray.cloud;
    sum.pixel.radiance += ray.cloud + environmentRadiance(params.environment, direction) * seen;
    sum.pixel.transmittance += transmittance;
    sum.pixel.alpha += 1.0 - (seen.x + seen.y + seen.z) / 3.0;
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
