// Which pixel an invocation of a drawing pass draws (workgroups of 16×4). The includer declares `params`, the push
// constants `push` and the buffer Blocks.
#ifndef LUMULUS_LIB_DRAWN_PIXEL
#define LUMULUS_LIB_DRAWN_PIXEL

#include "lib/square.glsl"
#include "shared/draw.h"

/// Place in the dispatch's rectangle. Eight invocations that run in step on lavapipe are 4×2 pixels, whose rays are alike.
ivec2 placeDrawn() {
    const ivec2 eight = ivec2(gl_LocalInvocationIndex >> 3u & 3u, gl_LocalInvocationIndex >> 5u);
    const ivec2 lane = ivec2(gl_LocalInvocationIndex & 3u, gl_LocalInvocationIndex >> 2u & 1u);
    return ivec2(gl_WorkGroupID.xy) * ivec2(16, 4) + eight * ivec2(4, 2) + lane;
}

/// The pixel, and where it is stored; false where this invocation has none.
bool drawnPixel(out ivec2 pixel, out int slot) {
    const SamplingGrid sampling = params.sampling;
    ivec2 place = placeDrawn();
    if (push.what == DRAW_SQUARES || push.what == DRAW_REFINED) {
        const uint index = gl_WorkGroupID.x * uint(LISTED_GROUP) + gl_LocalInvocationIndex / 3u;
        const int part = int(gl_LocalInvocationIndex % 3u) + 1;
        if (index >= blockCount || gl_LocalInvocationIndex / 3u >= uint(LISTED_GROUP)) return false;
        pixel = 2 * squareAt(blocks[index]) + ivec2(part & 1, part >> 1);
        place = pixel - push.first;
        if (push.what == DRAW_REFINED) pixel *= 2;
    } else {
        pixel = (push.first + place) * (push.what == DRAW_SPARSE ? sampling.spacing : 1);
    }
    slot = place.y * push.count.x + place.x;
    if (push.what == DRAW_SPARSE) {
        const ivec2 point = push.first + place - sampling.first;
        slot = point.y * sampling.size.x + point.x;
    }
    return all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, push.count));
}

#endif
