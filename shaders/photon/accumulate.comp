#version 460
#extension GL_GOOGLE_include_directive : require
// The finished generation takes the oldest one's place in the ring, and the running sum follows: exact in integers.
#include "shared/photon.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Generation { int64_t generation[]; };
layout(binding = 1, scalar) buffer Slot { int64_t slot[]; };
layout(binding = 2, scalar) buffer Sum { int64_t sum[]; };
layout(binding = 3, scalar) buffer Saturated { uint saturated; };
layout(push_constant, scalar) uniform Push { AccumulatePush push; };

// Generations and the sum stay within it, so that no step of the update can wrap.
const int64_t LIMIT = 0x1FFFFFFFFFFFFFFFl;

/// value · 2^shift, rounded to nearest; clamped and reported beyond the limit.
int64_t scaled(int64_t value, inout bool beyond) {
    if (push.shift <= 0) {
        const int down = min(-push.shift, 62);
        return down == 0 ? value : (value + (1l << (down - 1))) >> down;
    }
    const int up = min(push.shift, 62);
    beyond = beyond || value > (LIMIT >> up) || value < -(LIMIT >> up);
    return beyond ? (value < 0l ? -LIMIT : LIMIT) : value << up;
}

void main() {
    const uint i = linearInvocation(64u);
    if (i >= push.coefficients) return;
    bool beyond = false;
    const int64_t fresh = scaled(generation[i], beyond);
    const bool keep = push.keepSlots != 0u;
    const int64_t total = sum[i] + (fresh - (keep ? slot[i] : 0l));
    beyond = beyond || total > LIMIT || total < -LIMIT;
    if (keep) slot[i] = fresh;
    sum[i] = clamp(total, -LIMIT, LIMIT);
    if (beyond) atomicAdd(saturated, 1u);
}
