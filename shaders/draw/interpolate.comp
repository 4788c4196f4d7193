#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels between the points of the sampling grid: a block in which second differences from point to point are small is
// interpolated bilinearly, any other is listed. An eighth of the second difference is the error of the interpolation.
#include "shared/draw.h"

layout(local_size_x = 64) in;
/// Listed blocks are not drawn pixel by pixel but sampled at half the spacing next (interpolate_refined.comp), to which
/// the points half-way in other blocks are given too.
layout(constant_id = 0) const bool REFINES = false;
layout(constant_id = 4) const bool MANY = false;  // more than one cloud

layout(binding = 0, scalar) readonly buffer Params { DrawParams storedParams; };
layout(binding = 1, rgba32f) readonly uniform imageBuffer samplePoints;
layout(binding = 2, scalar) writeonly buffer Pixels { Pixel pixels[]; };
layout(binding = 3, scalar) buffer Blocks { uvec3 listGroups; uint listCount; uint listed[]; };
layout(binding = 4, scalar) writeonly buffer Refined { Pixel refined[]; };
layout(binding = 5, scalar) readonly buffer TileDetail { uint tileDetail[]; };
layout(push_constant, scalar) uniform Push { InterpolatePush push; };

DrawParams params;
#include "lib/sparse_sampling.glsl"
#include "lib/tile_detail.glsl"
#include "lib/linear.glsl"

int pointIndex(ivec2 point) {
    const ivec2 place = clamp(point - params.sampling.first, ivec2(0), params.sampling.size - 1);
    return place.y * params.sampling.size.x + place.x;
}

Pixel pointAt(ivec2 point) {
    const int index = pointIndex(point);
    return LOAD_PIXEL(samplePoints, index);
}

Probe probeAt(ivec2 point) {
    const int index = PIXEL_TEXELS * pointIndex(point);
    return probeOf(imageLoad(samplePoints, index), imageLoad(samplePoints, index + 1));
}

/// Second differences at point `i` of four by four, across and down together.
Probe bendAround(Probe around[16], int i) {
    return sum(bend(around[i - 1], around[i], around[i + 1]), bend(around[i - 4], around[i], around[i + 4]));
}

bool isCorner(ivec2 place) { return all(greaterThanEqual(place, ivec2(0))) && all(lessThanEqual(place, ivec2(1))); }

/// Whether the block's picture can be interpolated from the points around it.
bool isSmooth(ivec2 block, Pixel corners[4]) {
    Probe around[16];
    vec3 brightest = vec3(0.0);
    int empty = 0;
    for (int i = 0; i < 16; ++i) {
        const ivec2 place = ivec2(i & 3, i >> 2) - 1;
        if (isCorner(place))
            around[i] = probeOf(corners[2 * place.y + place.x]);
        else
            around[i] = probeAt(block + place);
        brightest = max(brightest, around[i].light);
        empty += isEmpty(around[i]) ? 1 : 0;
    }
    if (empty != 0) return empty == 16;
    bool within = true;
    for (int i = 0; i < 4; ++i)
        within = within && isWithin(bendAround(around, 5 + (i & 1) + 4 * (i >> 1)), brightest);
    return within;
}

void storeRefined(ivec2 place, Pixel value) {
    const int index = place.y * 2 * push.blocks.x + place.x;
    STORE_PIXEL(refined, index, value);
}

void storePixel(ivec2 pixel, Pixel value) {
    const ivec2 place = pixel - push.first;
    if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, push.count))) return;
    const int index = place.y * push.count.x + place.x;
    STORE_PIXEL(pixels, index, value);
}

void main() {
    params = storedParams;
    const int spacing = REFINES ? 4 : params.sampling.spacing;  // the loop below is unrolled then
    const int index = int(linearInvocation(64u));
    if (index >= push.blocks.x * push.blocks.y) return;
    const ivec2 local = ivec2(index % push.blocks.x, index / push.blocks.x);
    const ivec2 block = push.firstBlock + local;
    const Pixel corners[4] = Pixel[4](pointAt(block), pointAt(block + ivec2(1, 0)), pointAt(block + ivec2(0, 1)),
                                      pointAt(block + 1));
    if (REFINES) storeRefined(2 * local, corners[0]);
    if ((MANY && detailOf(block, spacing) > ANY_DETAIL) || !isSmooth(block, corners)) {
        list(block);
        if (!REFINES) storePixel(block * spacing, corners[0]);
        return;
    }
    for (int i = 0; i < spacing * spacing; ++i) {
        const ivec2 part = ivec2(i % spacing, i / spacing);
        const Pixel pixel = blend(corners, vec2(part) / float(spacing));
        storePixel(block * spacing + part, pixel);
        if (REFINES && i != 0 && all(equal(part & 1, ivec2(0)))) storeRefined(2 * local + part / 2, pixel);
    }
}
