#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_atomic_int64 : require
// One generation of photons. Each invocation walks photon after photon (its number, plus the number of invocations, …)
// and stops when its share of the record buffer is full or its steps are spent; the next dispatch goes on from there.
#include "shared/photon.h"
#include "shared/rng.h"
#include "shared/phase.h"
#include "shared/phase_table.h"
#include "lib/density.glsl"
#include "lib/emission.glsl"
#include "lib/environment_sample.glsl"
#include "lib/mesh_shade.glsl"
#include "lib/traversal.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool ANALYTIC_PHASE = true;
layout(constant_id = 1) const bool FORWARD_CUT = false;  // the forward peak is cut: some collisions go straight on
layout(constant_id = 2) const bool ABSORBS = false;     // an albedo below 1
layout(constant_id = 3) const bool PERIODIC = false;    // a plane-parallel layer across y
layout(constant_id = 4) const bool AXIS = false;        // the phase function has a backward peak
layout(constant_id = 5) const bool AIR = false;         // an atmosphere: its light differs by direction and place
layout(constant_id = 6) const bool GROUND = false;      // there is a ground below the cloud
#include "lib/store.glsl"

layout(binding = 0) uniform sampler3D density;
layout(binding = 2, scalar) readonly buffer Params { TraceParams storedParams; };
layout(binding = 3, r32f) uniform readonly image3D majorants;  // normalised; negative: distances in empty space
layout(binding = 4, scalar) readonly buffer InverseCdf { float inverseCdf[]; };
layout(binding = 5, scalar) buffer States { TraceState states[]; };
layout(binding = 7, scalar) buffer RecordCounts { uint recordCounts[]; };  // of each invocation

/// Cells that a photon may cross before the lanes that have met something go on.
const int CROSSINGS = 16;

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, in every step.
TraceParams params;
#include "lib/photon.glsl"
#include "lib/ground.glsl"

ScatterAngle samplePhase(float u) {
    if (ANALYTIC_PHASE) return sampleHg(params.asymmetry, u, params.scatterFraction);
    const TableCell cell = inverseCdfCell(u);
    return angleFromOneMinusCos(mix(inverseCdf[cell.base], inverseCdf[cell.base + 1], cell.fraction));
}

/// A random number of the density's mean (lib/density.glsl).
float densityNear(vec3 voxel, vec2 u) {
    if (!PERIODIC) return densityOfNear(density, voxel, u, ivec3(params.size));
    ivec3 near = voxelNear(voxel, u);
    near = clamp(near, ivec3(0), ivec3(params.size) - 1);  // a layer is as dense at its faces
    return densityOf(density, near, ivec3(params.size));
}

/// Of the photon's light, before its weight.
vec3 powerOf(TraceState state) { return state.photon < params.sunPhotons ? params.sunPower : params.skyPower; }

/// A real collision. False: the photon has ended. `scatters`: whether it goes on in another direction.
bool collide(inout TraceState state, vec3 voxel, vec4 u, uint lane, inout uint count, out bool scatters) {
    ++state.collisions;
    scatters = !FORWARD_CUT || u.x < params.scatterShare;
    if (!scatters) return survives(state, params.straightWeight, u.y);
    // The sun's first scattering is drawn from the shadow volume, not from the map (docs/architecture.md).
    const bool ofSun = state.photon < params.sunPhotons;
    if (AIR && state.scatterings == 0u) state.weight *= firstLightAt(ofSun, state, voxel);
    if (state.scatterings > 0u || !ofSun) {
        const vec3 power = (ofSun ? params.sunPower : params.skyPower) * state.weight;
        if (store(params, voxel, state.direction, power, ofSun, count * params.invocations + lane)) ++count;
    }
    ++state.scatterings;
    return !ABSORBS || survives(state, params.albedo, u.y);
}

/// A new direction: at a scattering event, or of a photon that enters. One rotation for both: on a CPU all lanes pay for what one
/// of them does.
void newDirection(inout TraceState state, inout Walk walk, bool enters, vec4 u, vec4 v) {
    const bool ofSun = state.photon < params.sunPhotons;
    const vec3 axis = enters ? lightAxis(params, ofSun, v.z, v.w) : state.direction;
    const ScatterAngle scattered = samplePhase(u.z);
    const ScatterAngle emitted = angleFromOneMinusCos(lightOneMinusCos(params, ofSun, u.z));
    const ScatterAngle angle = ScatterAngle(enters ? emitted.oneMinusCos : scattered.oneMinusCos, 0.0,
                                            enters ? emitted.sinTheta : scattered.sinTheta);
    state.direction = rotateDirection(axis, angle, 6.28318531 * u.w);
    const bool ofMap = AIR && enters && !ofSun;
    uint cell = 0u;
    if (ofMap) {
        cell = skyCell(u.z, u.x);
        state.direction = skyTravel(params.skyAxes, cell, vec2(u.w, v.w));
    }
    setVelocity(walk, params.worldToCells * state.direction);
    if (enters) {
        float area;
        const vec3 voxel = entryPoint(params, AIR || ofSun, state.direction, v.xy, v.z, area);
        const vec3 point = voxel / params.cellSize;
        walk.cell = clamp(ivec3(floor(point)), ivec3(0), params.cells - 1);
        walk.offset = clamp(point - vec3(walk.cell), 0.0, 1.0);
        state.weight = vec3(ofSun ? area / params.sunThrough : 1.0);
        if (ofMap) state.weight = FOG ? vec3(area) : skyWeight(cell, airPlace(params.air, voxel).y, area);
        if (GROUND && !FOG && !ofSun) state.weight *= skyOrGround(point, state.direction);
        if (MESHES && ofSun && inMeshShadow(point)) endPhoton(state);
    }
}

void main() {
    params = storedParams;
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= params.invocations) return;
    TraceState state = states[lane];
    Walk walk = makeWalk(state.cell, state.offset, params.worldToCells * state.direction, state.depth);
    uint count = 0u, events = 0u, nulls = 0u, absorbed = 0u, escaped = 0u, lost = 0u;
    uvec3 sides = uvec3(0u);  // reflected, transmitted diffusely, directly

    for (uint step = 0u; step < params.stepLimit && count < params.recordCapacity; ++step) {
        // Lanes that cross cells do not wait for those that have met something.
        float majorant = 0.0;
        uint event = state.alive != 0u ? WALK_CROSSED : WALK_LEFT;
        for (int crossed = 0; crossed < CROSSINGS && event == WALK_CROSSED; ++crossed) {
            majorant = imageLoad(majorants, walk.cell).r;
            event = walkStep(walk, majorant < 0.0 ? majorant : majorant * params.extinction, params.cells, PERIODIC);
        }
        const bool enters = event == WALK_LEFT;
        if (enters) {
            if (state.alive != 0u) {
                if (GROUND && state.collisions > 0u && bounce(state, walk, powerOf(state))) continue;
                ++escaped;
                if (PERIODIC) ++sides[walk.cell.y >= params.cells.y ? 0 : (state.collisions > 0u ? 1 : 2)];
                endPhoton(state);
            }
            if (state.photon >= params.photons) break;
            startPhoton(state);
        }
        if (event == WALK_CROSSED) continue;
        const vec4 u = draw(state);
        const vec4 v = draw(state);
        bool scatters = enters;
        if (event == WALK_COLLISION) {
            stepToCollision(walk, majorant * params.extinction);
            const vec3 voxel = (vec3(walk.cell) + walk.offset) * params.cellSize;
            if (u.x * majorant < densityNear(voxel, v.zw)) {
                ++events;
                if (!collide(state, voxel, v, lane, count, scatters)) {
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
        if (scatters) newDirection(state, walk, enters, u, v);
    }

    state.cell = walk.cell;
    state.offset = walk.offset;
    state.depth = walk.depth;
    states[lane] = state;
    recordCounts[lane] = count;
    addCounts(events, nulls, absorbed, escaped, lost, count, sides);
    if (state.alive != 0u || state.photon < params.photons) atomicAdd(counters.pending, 1u);
}
