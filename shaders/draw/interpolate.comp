#version 460
#extension GL_GOOGLE_include_directive : require
// Pixels between the points of the lattice: a block where the picture hardly bends is interpolated bilinearly, any other is
// listed for the drawing pass. What bends is the second difference from point to point, of which an eighth is the error
// of the interpolation.
#include "shared/draw.h"
#include "lib/view.glsl"
#include "shared/phase.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, scalar) readonly buffer Params { DrawParams storedParams; };
layout(binding = 1, scalar) readonly buffer Lattice { Pixel points[]; };
layout(binding = 2, scalar) writeonly buffer Pixels { Pixel pixels[]; };
layout(binding = 3, scalar) buffer Blocks { uvec3 blockGroups; uint blockCount; uint blocks[]; };
layout(push_constant, scalar) uniform Push { DrawPush push; };

DrawParams params;

int pointIndex(ivec2 point) {
    const ivec2 place = clamp(point - params.lattice.first, ivec2(0), params.lattice.size - 1);
    return place.y * params.lattice.size.x + place.x;
}

/// What is compared: the cloud's light; how much is seen through it, and of the sky; distance and front [m].
struct Probe {
    vec3 light;
    vec2 seen;
    vec2 distances;
};

/// Second differences at point `i` of four by four, across and down together.
Probe bend(Probe around[16], int i) {
    const Probe here = around[i], left = around[i - 1], right = around[i + 1], above = around[i - 4],
                below = around[i + 4];
    return Probe(abs(left.light - 2.0 * here.light + right.light) + abs(above.light - 2.0 * here.light + below.light),
                 abs(left.seen - 2.0 * here.seen + right.seen) + abs(above.seen - 2.0 * here.seen + below.seen),
                 abs(left.distances - 2.0 * here.distances + right.distances) +
                     abs(above.distances - 2.0 * here.distances + below.distances));
}

Probe probeAt(ivec2 point) {
    const int i = pointIndex(point);
    return Probe(points[i].cloud, vec2(points[i].transmittance.x, points[i].alpha),
                 vec2(points[i].depth, points[i].front));
}

/// Whether the block's picture can be interpolated from the points around it.
bool isSmooth(ivec2 block) {
    Probe around[16];
    vec3 brightest = vec3(0.0);
    int empty = 0;
    for (int i = 0; i < 16; ++i) {
        around[i] = probeAt(block + ivec2(i & 3, i >> 2) - 1);
        brightest = max(brightest, around[i].light);
        empty += around[i].distances.y >= FAR_DEPTH ? 1 : 0;
    }
    if (empty != 0) return empty == 16;
    const float tolerance = params.lattice.tolerance;
    bool smooth_ = true;
    for (int i = 0; i < 4; ++i) {
        const Probe bent = bend(around, 5 + (i & 1) + 4 * (i >> 1));
        smooth_ = smooth_ && all(lessThanEqual(bent.light, tolerance * brightest)) &&
                  all(lessThanEqual(bent.seen, vec2(0.5 * tolerance))) &&
                  all(lessThanEqual(bent.distances, vec2(params.lattice.depthTolerance)));
    }
    return smooth_;
}

/// Whether the sun's disc may shine into the block: by chords, which are precise also for small angles.
bool meetsSun(ivec2 block) {
    if (params.light.sunCone < 0.0) return false;
    const int spacing = params.lattice.spacing;
    vec3 origin, middle;
    viewRay(params.view, 2 * block * spacing + spacing, 2, origin, middle);
    float widest = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec3 corner;
        viewRay(params.view, (block + ivec2(i & 1, i >> 1)) * spacing, 1, origin, corner);
        widest = max(widest, distance(corner, middle));
    }
    return distance(middle, -params.light.sunTravel) <= sqrt(2.0 * params.light.sunCone) + 1.1 * widest;
}

void list(ivec2 block) {
    const uint place = atomicAdd(blockCount, 1u);
    const uint each = uint(DRAW_GROUP / (params.lattice.spacing * params.lattice.spacing));
    if (place % each == 0u) atomicAdd(blockGroups.x, 1u);
    const ivec2 local = block - params.lattice.first;
    blocks[place] = uint(local.y * params.lattice.size.x + local.x);
}

Pixel blend(Pixel a, Pixel b, float share) {
    return Pixel(mix(a.radiance, b.radiance, share), mix(a.cloud, b.cloud, share),
                 mix(a.transmittance, b.transmittance, share), mix(a.alpha, b.alpha, share),
                 mix(a.depth, b.depth, share), mix(a.front, b.front, share));
}

void main() {
    params = storedParams;
    const int spacing = params.lattice.spacing;
    const ivec2 last = push.first + push.count - 1;
    const ivec2 block = push.first / spacing + ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThan(block, last / spacing))) return;
    if (!isSmooth(block) || meetsSun(block)) {
        list(block);
        return;
    }
    const Pixel corners[4] = Pixel[4](points[pointIndex(block)], points[pointIndex(block + ivec2(1, 0))],
                                      points[pointIndex(block + ivec2(0, 1))], points[pointIndex(block + 1)]);
    for (int i = 0; i < spacing * spacing; ++i) {
        const ivec2 part = ivec2(i % spacing, i / spacing);
        const ivec2 place = block * spacing + part - push.first;
        if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, push.count))) continue;
        const vec2 share = vec2(part) / float(spacing);
        pixels[place.y * push.count.x + place.x] =
            blend(blend(corners[0], corners[1], share.x), blend(corners[2], corners[3], share.x), share.y);
    }
}
