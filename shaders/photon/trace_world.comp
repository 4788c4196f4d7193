#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_atomic_int64 : require
// One generation of photons through several clouds: they leave one and enter the next, and where clouds overlap each has its
// share of the extinction. Rounds as in trace.comp.
#include "shared/photon.h"
#include "shared/phase.h"
#include "shared/phase_table.h"
#include "lib/environment_sample.glsl"
#include "lib/merged_walk.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool ANALYTIC_PHASE = true;  // of all clouds
layout(constant_id = 1) const bool FORWARD_CUT = false;  // the forward peak of some is cut: some collisions go straight on
layout(constant_id = 2) const bool ABSORBS = false;      // an albedo of some is below 1
layout(constant_id = 4) const bool AXIS = false;         // the phase function of some has a backward peak
layout(constant_id = 5) const bool AIR = false;          // an atmosphere: its light differs by direction and place
layout(constant_id = 6) const bool GROUND = false;       // there is a ground below the clouds
const bool PERIODIC = false;
#include "lib/store.glsl"

layout(binding = 0) uniform sampler3D density;  // of all, as the index of collectors is
layout(binding = 2, scalar) readonly buffer Params { TraceParams storedParams; };
layout(binding = 3, scalar) readonly buffer Grid { MergedGridParams storedGrid; };
layout(binding = 4, scalar) readonly buffer InverseCdf { float inverseCdf[]; };
layout(binding = 5, scalar) buffer States { TraceState states[]; };
layout(binding = 7, scalar) buffer RecordCounts { uint recordCounts[]; };  // of each invocation

layout(binding = 31, rgba32f) uniform readonly imageBuffer starts;

/// Cells that a photon may cross before the lanes that have met something go on.
const int CROSSINGS = 16;

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, in every step.
TraceParams params;
MergedGridParams grid;
#include "lib/ground.glsl"

/// Metres from the corner of the grid.
vec3 metresOf(Walk walk) { return (vec3(walk.cell) + walk.offset) * grid.edge; }

#include "lib/walked_instance.glsl"

/// Which instance of the cell's list a tentative collision is with, by their shares of the majorant; −1: with none. The rest
/// of `u` after the extinctions before an instance is what its own is compared with, so that they add up.
int collisionIn(MergedCell cell, Walk walk, float u, vec2 near, out vec3 voxel) {
    const uint count = countInList(cell.list);
    float left = u * cell.majorant;
    for (uint place = 0u; place < count; ++place) {
        const uint instance = instanceInList(cell.list, place);
        voxel = voxelIn(instance, walk);
        left -= extinctionNear(instance, voxel, near);
        if (left < 0.0) return int(instance);
    }
    return -1;
}

/// The light at a collision with an instance, as a record of its collectors. False: none is there.
bool storeIn(uint instance, vec3 voxel, vec3 direction, vec3 power, bool ofSun, uint place) {
    const vec3 size = texelOf(instance, 3).xyz, first = texelOf(instance, 4).xyz;
    const vec3 inside = clamp(voxel, vec3(0.0), size - 0.5);
    const uint collector = SPARSE ? collectorIn(collectorIndex, ivec3(inside), ivec3(size), uint(first.x), uint(first.y))
                                  : texelFetch(collectorIndex, ivec3(first) + ivec3(inside), 0).r;
    const vec4 range = texelOf(instance, 10), cells = texelOf(instance, 9);
    if (collector >= floatBitsToUint(range.y)) return false;
    TraceParams its = params;
    its.estimatorEdge = int(texelOf(instance, 8).w);
    its.estimatorCells = ivec3(cells.xyz);
    its.estimatorBase = floatBitsToUint(cells.w);
    storeAt(its, floatBitsToUint(range.x) + collector, inside, direction, power, ofSun, place);
    return true;
}

/// Of the photon's light, before its weight.
vec3 powerOf(TraceState state) { return state.photon < params.sunPhotons ? params.sunPower : params.skyPower; }

/// A real collision. False: the photon has ended. `scatters`: whether it goes on in another direction.
bool collide(inout TraceState state, uint instance, Walk walk, vec3 voxel, vec4 u, uint lane, inout uint count, out bool scatters) {
    const bool ofSun = state.photon < params.sunPhotons;
    if (ofSun && state.collisions == 0u) state.weight *= texelOf(instance, 8).xyz;
    ++state.collisions;
    const vec4 scattering = texelOf(instance, 6);
    scatters = !FORWARD_CUT || u.x < scattering.w;
    if (!scatters) return survives(state, texelOf(instance, 7).xyz, u.y);
    if (AIR && state.scatterings == 0u) state.weight *= firstLightAt(ofSun, state, metresOf(walk));
    // The sun's first scattering is drawn from the shadow volumes, not from the map (docs/architecture.md).
    if (state.scatterings > 0u || !ofSun) {
        const vec3 power = (ofSun ? params.sunPower : params.skyPower) * state.weight;
        if (storeIn(instance, voxel, state.direction, power, ofSun, count * params.invocations + lane)) ++count;
    }
    ++state.scatterings;
    return !ABSORBS || survives(state, scattering.xyz, u.y);
}

ScatterAngle samplePhase(uint instance, float u) {
    const float table = texelOf(instance, 4).w;
    if (ANALYTIC_PHASE || table < 0.0) return sampleHg(texelOf(instance, 5).w, u, texelOf(instance, 7).w);
    const TableCell cell = inverseCdfCell(u);
    const int base = int(table) + cell.base;
    return angleFromOneMinusCos(mix(inverseCdf[base], inverseCdf[base + 1], cell.fraction));
}

/// A new direction at a scattering event in an instance.
void newDirection(inout TraceState state, inout Walk walk, uint instance, vec4 u) {
    state.direction = rotateDirection(state.direction, samplePhase(instance, u.z), 6.28318531 * u.w);
    setVelocity(walk, params.worldToCells * state.direction);
}

/// A photon begins where start_world.comp has put it.
void enter(inout TraceState state, inout Walk walk, int place) {
    const vec4 point = imageLoad(starts, START_TEXELS * place), direction = imageLoad(starts, START_TEXELS * place + 1);
    walk.cell = clamp(ivec3(floor(point.xyz)), ivec3(0), params.cells - 1);
    walk.offset = clamp(point.xyz - vec3(walk.cell), 0.0, 1.0);
    state.direction = direction.xyz;
    state.weight = vec3(point.w, direction.w, imageLoad(starts, START_TEXELS * place + 2).x);
    setVelocity(walk, params.worldToCells * state.direction);
}

/// Goes on until something is met, or for CROSSINGS cells.
uint walkOn(inout Walk walk, out MergedCell cell) {
    uint event = WALK_CROSSED;
    for (int crossed = 0; crossed < CROSSINGS && event == WALK_CROSSED; ++crossed) {
        cell = mergedCellAt(grid.bricks, walk.cell);
        event = leaveBox(walk, cell.majorant, cell.below, cell.above);
        if (event == WALK_CROSSED && !isInside(walk, params.cells)) event = WALK_LEFT;
    }
    return event;
}

void main() {
    params = storedParams;
    grid = storedGrid;
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= params.invocations) return;
    TraceState state = states[lane];
    Walk walk = makeWalk(state.cell, state.offset, params.worldToCells * state.direction, state.depth);
    uint begun = 0u, count = 0u, events = 0u, nulls = 0u, absorbed = 0u, escaped = 0u, lost = 0u;

    for (uint step = 0u; step < params.stepLimit && count < params.recordCapacity; ++step) {
        MergedCell cell;
        const uint event = state.alive != 0u ? walkOn(walk, cell) : WALK_LEFT;
        const bool enters = event == WALK_LEFT;
        if (enters) {
            if (state.alive != 0u) {
                if (GROUND && state.collisions > 0u && bounce(state, walk, powerOf(state))) continue;
                ++escaped;
                endPhoton(state);
            }
            if (state.photon >= params.photons || begun >= grid.starts) break;
            startPhoton(state);
            enter(state, walk, int(begun++ * params.invocations + lane));
        }
        if (event == WALK_CROSSED) continue;
        const vec4 u = draw(state);
        const vec4 v = draw(state);
        bool scatters = false;
        int instance = -1;
        if (event == WALK_COLLISION) {
            stepToCollision(walk, cell.majorant);
            vec3 voxel;
            instance = collisionIn(cell, walk, u.x, v.zw, voxel);
            if (instance >= 0) {
                ++events;
                if (!collide(state, uint(instance), walk, voxel, v, lane, count, scatters)) {
                    ++absorbed;
                    endPhoton(state);
                } else if (state.collisions >= params.collisionLimit) {
                    ++lost;
                    endPhoton(state);
                }
            } else {
                ++nulls;
            }
        }
        walk.depth = opticalDepth(u.y);
        if (scatters) newDirection(state, walk, uint(instance), u);
    }

    state.cell = walk.cell;
    state.offset = walk.offset;
    state.depth = walk.depth;
    states[lane] = state;
    recordCounts[lane] = count;
    addCounts(events, nulls, absorbed, escaped, lost, count, uvec3(0u));
    if (state.alive != 0u || state.photon < params.photons) atomicAdd(counters.pending, 1u);
}
