// Which collector's leaf a voxel lies in: by an image with its number for each voxel or, where the density is in bricks, by
// the kD-tree. There `collectorIndex` has for each entry of the bricks' index the smallest node of the tree that holds the
// whole brick, and behind the entries all nodes. A node is (axis << 30 | plane, place of its children) or, with an axis
// of 3, a leaf: (…, number of its collector).
#ifndef LUMULUS_LIB_COLLECTOR
#define LUMULUS_LIB_COLLECTOR

#include "lib/bricks.glsl"

/// Of a field whose bricks and nodes begin with these texels of the indices.
uint collectorIn(usampler3D collectorIndex, ivec3 voxel, ivec3 size, uint firstBrick, uint firstNode) {
    const uint entry = brickEntry(voxel / BRICK_EDGE, size, firstBrick) - firstBrick;
    uvec2 node = texelFetch(collectorIndex, indexTexel(firstNode + entry), 0).xy;
    for (int depth = 0; depth < 64 && (node.x >> 30) != 3u; ++depth) {
        const bool above = voxel[node.x >> 30] >= int(node.x & 0x3FFFFFFFu);
        node = texelFetch(collectorIndex, indexTexel(firstNode + node.y + (above ? 1u : 0u)), 0).xy;
    }
    return node.y;
}

uint collectorOf(usampler3D collectorIndex, ivec3 voxel, ivec3 size) {
    if (!SPARSE) return texelFetch(collectorIndex, voxel, 0).r;
    return collectorIn(collectorIndex, voxel, size, 0u, 0u);
}

#endif
