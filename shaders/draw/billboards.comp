#version 460
#extension GL_GOOGLE_include_directive : require
// Billboards (Elek 2011, 5.9) as spheres that face the eye point: each pixel goes through its tile's list front to back,
// which is the same blending as back to front, and stops where nothing behind can be seen.
#include "shared/draw.h"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool ONE_TURN = false;
layout(constant_id = 1) const bool SUN = true;      // the sun shines
layout(constant_id = 2) const bool PHOTONS = true;  // there is a photon map

layout(binding = 0, scalar) readonly buffer Params { DrawParams params; };
layout(binding = 1, scalar) readonly buffer Billboards { Billboard billboards[]; };
layout(binding = 2, scalar) readonly buffer TileOffsets { uint tileOffsets[]; };
layout(binding = 3, scalar) readonly buffer TileLists { uint tileLists[]; };
layout(binding = 4, scalar) readonly buffer Radiance { vec3 collectorRadiance[]; };
layout(binding = 5, scalar) readonly buffer SunDepths { float sunDepths[]; };
layout(binding = 6, scalar) readonly buffer PhaseTable { float phaseTable[]; };
layout(binding = 7, scalar) readonly buffer OneTurnH { float oneTurnH[]; };
layout(binding = 8, scalar) readonly buffer OneTurnK { float oneTurnK[]; };
layout(binding = 9, scalar) writeonly buffer Pixels { Pixel pixels[]; };

#include "lib/sun_source.glsl"

/// Optical depth of the turned light beyond which a pixel is opaque.
const float OPAQUE = 12.0;

struct Blend {
    vec3 cloud;
    float depth;     // true optical depth so far
    float distance;  // sum of weight · distance
    float weight;
    float front;
};

void blend(inout Blend sum, SunView sun, Billboard billboard, vec3 origin, vec3 direction) {
    const vec3 centre = billboard.centre - origin;
    const float along = dot(centre, direction);
    const vec3 closest = centre - along * direction;
    const float squared = billboard.radius * billboard.radius - dot(closest, closest);
    if (squared <= 0.0) return;
    const float half_ = sqrt(squared);
    const float near = max(along - half_, 0.0), far = along + half_;
    if (far <= near) return;
    const float thickness = billboard.extinction * (far - near);
    const vec3 turned = params.light.decay * thickness;
    // multiply scattered light: (1 − f) σs L against the turned medium's own extinction κ σt
    const vec3 filled = mix((1.0 - exp(-turned)) / max(params.light.decay, 1.0e-6), vec3(thickness),
                            lessThan(turned, vec3(1.0e-3)));
    if (PHOTONS) {
        const vec3 source = params.light.albedo * params.light.turnShare * max(collectorRadiance[billboard.collector], 0.0);
        sum.cloud += source * filled * exp(-params.light.decay * sum.depth);
    }
    if (SUN) sum.cloud += sunScattered(sun, params.light, sunDepths[billboard.collector], sum.depth, thickness);
    const float weight = exp(-sum.depth) * (1.0 - exp(-thickness));
    sum.distance += weight * 0.5 * (near + far);
    sum.weight += weight;
    sum.front = min(sum.front, near);
    sum.depth += thickness;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, params.firstRow);
    if (pixel.x >= params.view.size.x || pixel.y >= params.firstRow + params.rows) return;
    vec3 origin, direction;
    viewRay(params.view, pixel, origin, direction);
    const SunView sun = sunView(params.light, direction);

    Blend sum = Blend(vec3(0.0), 0.0, 0.0, 0.0, FAR_DEPTH);
    const uint tile = uint((pixel.y / TILE_EDGE) * params.tilesAcross + pixel.x / TILE_EDGE);
    const uint last = tileOffsets[tile + 1u];
    const vec3 decay = params.light.decay;
    const float opaque = OPAQUE / max(min(decay.x, min(decay.y, decay.z)), 0.01);
    for (uint i = tileOffsets[tile]; i < last && sum.depth < opaque; ++i)
        blend(sum, sun, billboards[tileLists[i]], origin, direction);

    Pixel result;
    const float transmittance = exp(-sum.depth);
    const vec3 turned = exp(-params.light.decay * sum.depth);
    result.cloud = sum.cloud;
    result.radiance = sum.cloud + background(params.light, direction, transmittance, turned);
    result.transmittance = vec3(transmittance);
    result.alpha = 1.0 - (turned.x + turned.y + turned.z) / 3.0;
    result.depth = sum.weight > 0.0 ? sum.distance / sum.weight : FAR_DEPTH;
    result.front = sum.front;
    pixels[(pixel.y - params.firstRow) * params.view.size.x + pixel.x] = result;
}
