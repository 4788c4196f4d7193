// What a photon leaves at a scattering event: a record for the collector of that place, and estimates in the cells around it.
// It brings its bindings along: trace.comp walks, this file alone writes light. The includer declares AXIS: whether the sun's
// light is counted in rings about its axis too.
#ifndef LUMULUS_LIB_STORE
#define LUMULUS_LIB_STORE

#extension GL_EXT_shader_atomic_int64 : require
#include "shared/collision_estimator.h"
#include "shared/photon.h"
#include "shared/sun_axis.h"
#include "lib/luminance.glsl"
#include "lib/packing.glsl"

layout(binding = 1) uniform usampler3D collectorIndex;
layout(binding = 6, scalar) writeonly buffer Records { PhotonRecord records[]; };
layout(binding = 8, scalar) buffer CollectorCounts { uint collectorCounts[]; };  // records of each collector
layout(binding = 10, scalar) buffer CollisionEstimates { int64_t estimates[]; };

/// `amount` in counts of the coefficients, luminance.
void addEstimate(TraceParams params, vec3 voxel, vec3 direction, float amount) {
    const ivec3 cell = min(ivec3(voxel) / params.estimatorEdge, params.estimatorCells - 1);
    const uint cube = params.estimatorBase + cubePlace(params.estimatorCells, cell);
    atomicAdd(estimates[cube + placeInCube(cell)], int64_t(roundEven(amount)));
    for (int axis = 0; axis < 3; ++axis)
        atomicAdd(estimates[cube + uint(CUBE_CELLS + axis)], int64_t(roundEven(amount * direction[axis])));
}

/// Counts the sun's light in the rings about its axis.
void addToAxis(TraceParams params, uint collector, vec3 direction, vec3 power) {
    const ScatterAngle angle = angleBetween(params.sunDirection, direction);
    const bool front = angle.oneMinusCos < angle.onePlusCos;
    const int ring = axisRing(sqrt(2.0 * (front ? angle.oneMinusCos : angle.onePlusCos))) + (front ? 0 : AXIS_RINGS);
    const uint place = params.axisBase + collector * AXIS_COUNTS + 3u * uint(ring);
    for (int channel = 0; channel < 3; ++channel)
        atomicAdd(estimates[place + uint(channel)], int64_t(roundEven(COEFFICIENT_SCALE * power[channel])));
}

/// Light of this power [record units] that travels in a direction, at a voxel of a collector, as record number `place`.
void storeAt(TraceParams params, uint collector, vec3 voxel, vec3 direction, vec3 power, bool ofSun, uint place) {
    records[place] = PhotonRecord(collector, packDirection(direction), packPower(power));
    if (params.estimatorEdge > 0) addEstimate(params, voxel, direction, COEFFICIENT_SCALE * luminance(power));
    if (AXIS && ofSun) addToAxis(params, collector, direction, power);
    atomicAdd(collectorCounts[collector], 1u);
}

/// The same, whichever collector is there. False: none is, and nothing is left.
bool store(TraceParams params, vec3 voxel, vec3 direction, vec3 power, bool ofSun, uint place) {
    const uint collector = texelFetch(collectorIndex, ivec3(min(voxel, params.size - 0.5)), 0).r;
    if (collector >= params.collectors) return false;
    storeAt(params, collector, voxel, direction, power, ofSun, place);
    return true;
}

#endif
