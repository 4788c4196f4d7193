#version 460
#extension GL_GOOGLE_include_directive : require
// Writes into every voxel the number of the collector that its leaf feeds, so that one fetch finds it.
#include "shared/cloud.h"
#include "lib/linear.glsl"

layout(local_size_x = 32) in;
layout(binding = 0, scalar) readonly buffer Leaves { LeafBox leaves[]; };
layout(binding = 1, scalar) readonly buffer Collectors { uint collectorOfLeaf[]; };
layout(binding = 2) uniform writeonly uimage3D collectorIndex;
layout(push_constant, scalar) uniform Push { LeafPush push; };

void main() {
    const uint leaf = linearGroup();
    if (leaf >= push.leaves) return;
    const ivec3 lower = leaves[leaf].lower;
    const uvec3 extent = uvec3(leaves[leaf].upper - lower);
    const uint collector = collectorOfLeaf[leaf];
    for (uint i = gl_LocalInvocationID.x; i < extent.x * extent.y * extent.z; i += 32u) {
        const ivec3 voxel = lower + ivec3(i % extent.x, (i / extent.x) % extent.y, i / (extent.x * extent.y));
        imageStore(collectorIndex, voxel, uvec4(collector));
    }
}
