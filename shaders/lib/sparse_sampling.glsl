// What passes over the points of a sampling share: what of a picture is compared, lists of what cannot be interpolated.
// The includer declares `params` and a buffer of listGroups (a dispatch's), listCount and listed[].
#ifndef LUMULUS_LIB_LATTICE
#define LUMULUS_LIB_LATTICE

#include "shared/draw.h"
#include "lib/pixel.glsl"
#include "lib/square.glsl"

/// What is compared: the cloud's light; how much is seen through it, and of the sky; distance and front [m].
struct Probe {
    vec3 light;
    vec2 seen;
    vec2 distances;
};

Probe probeOf(Pixel pixel) {
    return Probe(pixel.cloud, vec2(pixel.transmittance, pixel.alpha), vec2(pixel.depth, pixel.front));
}

/// From the first two texels of a pixel.
Probe probeOf(vec4 first, vec4 second) { return Probe(first.rgb, vec2(first.a, second.x), second.yz); }

bool isEmpty(Probe probe) { return probe.distances.y >= FAR_DEPTH; }

/// Second difference of three in a row.
Probe bend(Probe before, Probe here, Probe after) {
    return Probe(abs(before.light - 2.0 * here.light + after.light), abs(before.seen - 2.0 * here.seen + after.seen),
                 abs(before.distances - 2.0 * here.distances + after.distances));
}

Probe sum(Probe a, Probe b) { return Probe(a.light + b.light, a.seen + b.seen, a.distances + b.distances); }

/// Whether second differences are small against the brightest around.
bool isWithin(Probe bent, vec3 brightest) {
    const float tolerance = params.sampling.tolerance;
    return all(lessThanEqual(bent.light, tolerance * brightest)) &&
           all(lessThanEqual(bent.seen, vec2(0.4 * tolerance))) &&
           all(lessThanEqual(bent.distances, vec2(params.sampling.depthTolerance)));
}

Pixel blend(Pixel a, Pixel b, float share) {
    return Pixel(mix(a.cloud, b.cloud, share), mix(a.transmittance, b.transmittance, share),
                 mix(a.alpha, b.alpha, share), mix(a.depth, b.depth, share), mix(a.front, b.front, share),
                 mix(a.radiance, b.radiance, share), vec2(0.0));
}

/// Lists a square of pixels by its corner in units of its edge.
void list(ivec2 square) {
    const uint place = atomicAdd(listCount, 1u);
    if (place % uint(LISTED_GROUP) == 0u) atomicAdd(listGroups.x, 1u);
    listed[place] = packedSquare(square);
}

/// Between four corners, row by row.
Pixel blend(Pixel corners[4], vec2 share) {
    return blend(blend(corners[0], corners[1], share.x), blend(corners[2], corners[3], share.x), share.y);
}

#endif
