#version 460
#extension GL_GOOGLE_include_directive : require
// Counting sort, second half: every record to its collector's range. The order inside a range is that of the atomics;
// the sums are integers, so it does not matter.
#include "shared/photon.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Records { PhotonRecord records[]; };
layout(binding = 1, scalar) readonly buffer RecordCounts { uint recordCounts[]; };
layout(binding = 2, scalar) buffer Cursors { uint cursors[]; };
layout(binding = 3, scalar) writeonly buffer Sorted { uvec3 sorted[]; };  // direction, power
layout(push_constant, scalar) uniform Push { GatherPush push; };

void main() {
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= push.invocations) return;
    const uint count = recordCounts[lane];
    for (uint slot = gl_GlobalInvocationID.y; slot < count; slot += gl_NumWorkGroups.y) {
        const PhotonRecord record = records[slot * push.invocations + lane];
        const uint place = atomicAdd(cursors[record.collector], 1u);
        sorted[place] = uvec3(record.direction, record.power);
    }
}
