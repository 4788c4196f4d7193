#version 460
#extension GL_GOOGLE_include_directive : require
// Counting sort, first half: where each collector's records begin, and how many chunks the gather pass needs.
#include "shared/photon.h"

layout(local_size_x = 256) in;
layout(binding = 0, scalar) readonly buffer CollectorCounts { uint collectorCounts[]; };
layout(binding = 1, scalar) writeonly buffer Cursors { uint cursors[]; };          // first record of each collector
layout(binding = 2, scalar) writeonly buffer ChunkOffsets { uint chunkOffsets[]; };  // first chunk of each; one more: all
layout(binding = 3, scalar) writeonly buffer GatherArguments { uvec3 gatherGroups; };
layout(push_constant, scalar) uniform Push { GatherPush push; };

shared uvec2 partial[256];

uvec2 costOf(uint collector) {
    const uint records = collectorCounts[collector];
    return uvec2(records, (records + GATHER_CHUNK - 1u) / GATHER_CHUNK);
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint share = (push.collectors + 255u) / 256u;
    const uint first = min(lane * share, push.collectors);
    const uint last = min(first + share, push.collectors);
    uvec2 sum = uvec2(0u);
    for (uint i = first; i < last; ++i) sum += costOf(i);
    partial[lane] = sum;
    barrier();
    uvec2 before = uvec2(0u);
    // The same trip count for all lanes: lavapipe 22.3 never leaves this loop where it ends at the lane.
    for (uint i = 0u; i < 256u; ++i) before += i < lane ? partial[i] : uvec2(0u);
    for (uint i = first; i < last; ++i) {
        cursors[i] = before.x;
        chunkOffsets[i] = before.y;
        before += costOf(i);
    }
    if (lane == 255u) {
        chunkOffsets[push.collectors] = before.y;
        // folded into two axes like gpu::linearGroups
        const uint groups = (before.y + 63u) / 64u;
        gatherGroups = uvec3(min(groups, 32768u), (groups + 32767u) / 32768u, 1u);
    }
}
