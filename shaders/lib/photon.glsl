// What becomes of a photon between its collisions, whatever it walks through. The includer declares `params` and the constant
// PERIODIC.
#ifndef LUMULUS_LIB_PHOTON
#define LUMULUS_LIB_PHOTON

#include "shared/photon.h"
#include "shared/rng.h"

layout(binding = 9, scalar) buffer Counters { TraceCounters counters; };

vec4 draw(inout TraceState state) {
    return rngUniform4(uvec4(state.photon, state.draws++, params.generation, params.stream));
}

/// Multiplies the weight; where that lowers its largest channel, Russian roulette keeps it up. False: absorbed.
bool survives(inout TraceState state, vec3 factor, float u) {
    const float before = max(state.weight.x, max(state.weight.y, state.weight.z));
    state.weight *= factor;
    const float after = max(state.weight.x, max(state.weight.y, state.weight.z));
    if (!(u * before < after)) return false;
    state.weight *= before / after;
    return true;
}

/// A photon that has not entered yet.
void startPhoton(inout TraceState state) {
    state.draws = 0u;
    state.collisions = 0u;
    state.scatterings = 0u;
    state.alive = 1u;
}

void endPhoton(inout TraceState state) {
    state.alive = 0u;
    state.photon += params.invocations;
}

void addCounts(uint events, uint nulls, uint absorbed, uint escaped, uint lost, uint recorded, uvec3 sides) {
    atomicAdd(counters.events, uint64_t(events));
    atomicAdd(counters.nulls, uint64_t(nulls));
    atomicAdd(counters.absorbed, uint64_t(absorbed));
    atomicAdd(counters.escaped, uint64_t(escaped));
    atomicAdd(counters.lost, uint64_t(lost));
    atomicAdd(counters.records, uint64_t(recorded));
    if (PERIODIC) {
        atomicAdd(counters.reflected, uint64_t(sides.x));
        atomicAdd(counters.transmittedDiffuse, uint64_t(sides.y));
        atomicAdd(counters.transmittedDirect, uint64_t(sides.z));
    }
}

#endif
