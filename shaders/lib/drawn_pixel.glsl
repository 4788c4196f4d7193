// Which pixel an invocation of a drawing pass draws (workgroups of 16×4). The includer declares `params`, the push
// constants `push` and the buffer Blocks.
#ifndef LUMULUS_LIB_DRAWN_PIXEL
#define LUMULUS_LIB_DRAWN_PIXEL

#include "shared/draw.h"

/// The pixel, and where it is stored; false where this invocation has none.
bool drawnPixel(out ivec2 pixel, out int slot) {
    const LatticeParams lattice = params.lattice;
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (push.what == DRAW_BLOCKS) {
        const uint each = uint(lattice.spacing * lattice.spacing);
        const uint index = gl_WorkGroupID.x * uint(DRAW_GROUP) + gl_LocalInvocationIndex;
        if (index / each >= blockCount) return false;
        const int block = int(blocks[index / each]), part = int(index % each);
        pixel = (lattice.first + ivec2(block % lattice.size.x, block / lattice.size.x)) * lattice.spacing +
                ivec2(part % lattice.spacing, part / lattice.spacing);
        place = pixel - push.first;
    } else {
        pixel = (push.first + place) * (push.what == DRAW_LATTICE ? lattice.spacing : 1);
    }
    slot = place.y * push.count.x + place.x;
    if (push.what == DRAW_LATTICE) {
        const ivec2 point = push.first + place - lattice.first;
        slot = point.y * lattice.size.x + point.x;
    }
    return all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, push.count));
}

#endif
