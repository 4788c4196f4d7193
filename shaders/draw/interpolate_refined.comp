#version 460
#extension GL_GOOGLE_include_directive : require
// Listed blocks of four by four pixels, with every second pixel of every second row there: their four cells are
// interpolated where second differences at that spacing are small; others are listed to be drawn pixel by pixel.
#include "shared/draw.h"

layout(local_size_x = 88) in;  // the cells of LISTED_GROUP blocks, and four more

layout(constant_id = 4) const bool MANY = false;  // more than one cloud

layout(binding = 0, scalar) readonly buffer Params { DrawParams storedParams; };
layout(binding = 1, rgba32f) readonly uniform imageBuffer refined;
layout(binding = 2, scalar) writeonly buffer Pixels { Pixel pixels[]; };
layout(binding = 3, scalar) readonly buffer Blocks { uvec3 blockGroups; uint blockCount; uint blocks[]; };
layout(binding = 4, scalar) buffer Cells { uvec3 listGroups; uint listCount; uint listed[]; };
layout(binding = 5, scalar) readonly buffer TileDetail { uint tileDetail[]; };
layout(push_constant, scalar) uniform Push { InterpolatePush push; };

DrawParams params;
#include "lib/sparse_sampling.glsl"
#include "lib/tile_detail.glsl"

int refinedIndex(ivec2 point) {
    const ivec2 place = min(point - 2 * push.firstBlock, 2 * push.blocks - 1);
    return place.y * 2 * push.blocks.x + place.x;
}

Pixel pointAt(ivec2 point) {
    const int index = refinedIndex(point);
    return LOAD_PIXEL(refined, index);
}

/// Second difference along the three points of a block, from `start` by `aside`; counts those that see nothing.
Probe bendAlong(ivec2 start, ivec2 aside, inout vec3 brightest, inout int empty) {
    Probe along[3];
    for (int i = 0; i < 3; ++i) {
        const int index = PIXEL_TEXELS * refinedIndex(start + i * aside);
        along[i] = probeOf(imageLoad(refined, index), imageLoad(refined, index + 1));
        brightest = max(brightest, along[i].light);
        empty += isEmpty(along[i]) ? 1 : 0;
    }
    return bend(along[0], along[1], along[2]);
}

/// Whether a cell can be interpolated between its corners. Where nothing is seen at them there may be something between: a
/// block that is empty all round is not listed.
bool isSmooth(ivec2 cell) {
    const ivec2 block = cell & ~1;
    bool within = true;
    int empty = 0;
    for (int i = 0; i < 2; ++i) {
        vec3 brightest = vec3(0.0);
        const Probe across = bendAlong(ivec2(block.x, cell.y + i), ivec2(1, 0), brightest, empty);
        const Probe down = bendAlong(ivec2(cell.x + i, block.y), ivec2(0, 1), brightest, empty);
        within = within && isWithin(sum(across, down), brightest);
    }
    return within && empty == 0;
}

void main() {
    params = storedParams;
    const uint index = gl_WorkGroupID.x * uint(LISTED_GROUP) + gl_LocalInvocationIndex / 4u;
    if (index >= blockCount || gl_LocalInvocationIndex / 4u >= uint(LISTED_GROUP)) return;
    const ivec2 cell = 2 * squareAt(blocks[index]) + ivec2(gl_LocalInvocationIndex & 1u, gl_LocalInvocationIndex >> 1u & 1u);
    const ivec2 place = 2 * cell - push.first;
    if (any(lessThanEqual(place, ivec2(-2))) || any(greaterThanEqual(place, push.count))) return;
    const Pixel corners[4] = Pixel[4](pointAt(cell), pointAt(cell + ivec2(1, 0)), pointAt(cell + ivec2(0, 1)),
                                      pointAt(cell + 1));
    const bool drawn = (MANY && detailOf(cell, 2) == DETAIL_OF_PIXELS) || !isSmooth(cell);
    if (drawn) list(cell);
    for (int i = 0; i < (drawn ? 1 : 4); ++i) {
        const ivec2 part = ivec2(i & 1, i >> 1);
        if (any(lessThan(place + part, ivec2(0))) || any(greaterThanEqual(place + part, push.count))) continue;
        const Pixel pixel = drawn ? corners[0] : blend(corners, 0.5 * vec2(part));
        const int index = (place.y + part.y) * push.count.x + place.x + part.x;
        STORE_PIXEL(pixels, index, pixel);
    }
}
