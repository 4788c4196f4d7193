#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// Light that photons counted in each cell of the light field against what its collectors have there on average, whatever
// the view: collectors know where light goes, cells how much there is and, less sharply, where most of it goes.
#include "shared/collision_estimator.h"
#include "shared/draw.h"
#include "shared/photon.h"
#include "lib/collector.glsl"
#include "lib/density.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int EDGE = 1;  // of a cell, voxels
layout(binding = 0) uniform sampler3D density;
layout(binding = 1) uniform usampler3D collectorIndex;
layout(binding = 2, rgba32f) uniform readonly image2D fluences;  // flux, fluence
layout(binding = 3, scalar) readonly buffer CollisionEstimates { int64_t estimates[]; };
layout(binding = 4, r32f) uniform readonly image3D cellMass;
layout(binding = 5) uniform writeonly image3D counts;    // gain towards a direction (vector), ratio
layout(binding = 6) uniform writeonly image3D trust;     // share of the cell in the smoothed field, sharpness: photons · (transport free paths along the cell)²
layout(binding = 7, scalar) readonly buffer LitCells { uint litCells[]; };
layout(push_constant, scalar) uniform Push { LightCountsPush push; };

const float PI = 3.14159265;
/// Photons that a cell is taken to have met, as many as its collectors have there on average, beside those that were
/// counted: what holds the noise of cells that few meet. The same for the cubes of flux, which hold eight cells.
const float PRIOR = 10.0, FLUX_PRIOR = 40.0;
/// Part of the difference of directions that is believed: the bands above, which would follow, do not.
const float FLUX_BELIEF = 0.85;
/// Photons in a cell that make it count as much as the mean of its surroundings.
const float OWN = 150.0;

/// Counts of the cells of estimates from `first` on, `across` along each edge.
float countedIn(ivec3 first, int across) {
    const ivec3 end = min(first + across, push.estimatorCells);
    int64_t sum = 0l;
    for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x) {
                const ivec3 cell = ivec3(x, y, z);
                sum += estimates[push.estimatorBase + cubePlace(push.estimatorCells, cell) + placeInCube(cell)];
            }
    return push.estimatorScale * float(sum);
}

/// The same of the flux in cubes; `first` and `across` are multiples of FLUX_EDGE.
vec3 fluxIn(ivec3 first, int across) {
    const ivec3 end = min(first + across, push.estimatorCells);
    vec3 sum = vec3(0.0);
    for (int z = first.z; z < end.z; z += FLUX_EDGE)
        for (int y = first.y; y < end.y; y += FLUX_EDGE)
            for (int x = first.x; x < end.x; x += FLUX_EDGE) {
                const uint place =
                    push.estimatorBase + cubePlace(push.estimatorCells, ivec3(x, y, z)) + uint(CUBE_CELLS);
                sum += vec3(estimates[place], estimates[place + 1u], estimates[place + 2u]);
            }
    return push.estimatorScale * sum;
}

/// How much the light's mean direction in the cubes around a cell differs from that of its collectors, flux/fluence.
vec3 fluxDeviation(ivec3 cell, vec3 collectors) {
    const int across = max(push.estimatorAcross, FLUX_EDGE);
    const ivec3 first = cell * push.estimatorAcross / across * across;
    const float amount = countedIn(first, across);
    return (fluxIn(first, across) - amount * collectors) / (amount + FLUX_PRIOR * push.photon);
}

void main() {
    const int STRIDE = SPARSE ? max(EDGE / 4, 1) : 1;  // where there are many voxels, some stand for all of a cell
    const uint entry = linearInvocation(64u);
    if (entry >= push.occupied) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    vec4 light = vec4(0.0);  // flux, fluence
    float mass = 0.0;
    for (int z = STRIDE / 2; z < EDGE; z += STRIDE)
        for (int y = STRIDE / 2; y < EDGE; y += STRIDE)
            for (int x = STRIDE / 2; x < EDGE; x += STRIDE) {
                const ivec3 voxel = EDGE * cell + ivec3(x, y, z);
                const float here = densityOf(density, voxel, push.size);
                if (here > 0.0) {
                    const uint collector = push.firstCollector + collectorOf(collectorIndex, voxel, push.size);
                    light += here * imageLoad(fluences, collectorTexel(collector));
                    mass += here;
                }
            }
    vec4 result = vec4(0.0, 0.0, 0.0, 1.0);
    vec2 trusted = vec2(0.0);
    if (light.w > 0.0 && push.photon > 0.0) {
        light /= mass;
        const float counted = countedIn(cell * push.estimatorAcross, push.estimatorAcross);
        const float expected = light.w * imageLoad(cellMass, cell).r * push.massScale;
        const float prior = PRIOR * push.photon;
        const float ratio = (counted + prior) / (expected + prior);
        const vec3 turned = fluxDeviation(cell, light.xyz / light.w);
        result = vec4(3.0 / (4.0 * PI) * push.moment * FLUX_BELIEF * ratio * light.w * turned, ratio);
        const float thickness = push.thickness * imageLoad(cellMass, cell).r;
        trusted = vec2(counted / (counted + OWN * push.photon), thickness * thickness * counted / push.photon);
    }
    imageStore(counts, cell, result);
    imageStore(trust, cell, vec4(trusted, 0.0, 0.0));
}
