#version 460
#extension GL_GOOGLE_include_directive : require
// Where the next photons of each invocation of trace_world.comp begin. Of the lanes of a walk one in ten begins a photon in a
// step, and the others would wait while it looks for what else is on its line: here all lanes begin one.
#include "shared/photon.h"
#include "shared/phase.h"
#include "shared/rng.h"
#include "lib/linear.glsl"
#include "lib/entry_disc.glsl"
#include "lib/environment_sample.glsl"
#include "lib/ground_light.glsl"
#include "lib/mesh_shade.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 5) const bool AIR = false;     // an atmosphere: its light differs by direction and place
layout(constant_id = 6) const bool GROUND = false;  // there is a ground below the clouds

layout(binding = 2, scalar) readonly buffer Params { TraceParams storedParams; };
layout(binding = 3, scalar) readonly buffer Grid { MergedGridParams storedGrid; };
layout(binding = 5, scalar) readonly buffer States { TraceState states[]; };
layout(binding = 31, rgba32f) uniform writeonly imageBuffer starts;

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe.
TraceParams params;
MergedGridParams grid;

/// The angle of light to an axis: to the sun's middle, or of a sky that is the same everywhere to any.
ScatterAngle lightAngle(bool ofSun, float u) { return angleFromOneMinusCos(ofSun ? params.sunCone * u : 2.0 * u); }

void main() {
    params = storedParams;
    grid = storedGrid;
    const uint place = linearInvocation(64u);
    const uint lane = place % params.invocations, begun = place / params.invocations;
    if (begun >= grid.starts) return;
    const uint photon = states[lane].photon + (begun + (states[lane].alive != 0u ? 1u : 0u)) * params.invocations;
    if (photon >= params.photons) return;
    // the first two numbers of a photon are for this, but for the way to its first collision
    const vec4 u = rngUniform4(uvec4(photon, 0u, params.generation, params.stream));
    const vec4 v = rngUniform4(uvec4(photon, 1u, params.generation, params.stream));
    const bool ofSun = photon < params.sunPhotons;
    const vec3 axis = ofSun ? params.sunDirection : vec3(0.0, 1.0, 0.0);
    vec3 direction = rotateDirection(axis, lightAngle(ofSun, u.z), 6.28318531 * u.w);
    const bool ofMap = AIR && !ofSun;
    uint cell = 0u;
    if (ofMap) {
        cell = skyCell(u.z, u.x);
        direction = skyTravel(params.skyAxes, cell, vec2(u.w, v.w));
    }
    float area;
    const vec3 entry = entryPoint(grid, direction, v.xyz, area);
    const vec3 point = entry / grid.edge;
    vec3 weight = vec3(area / grid.largestWeight);
    if (ofMap) weight = FOG ? vec3(area) : skyWeight(cell, airPlace(params.air, entry).y, area);
    if (GROUND && !FOG && !ofSun) weight *= skyOrGround(point, direction);
    if (MESHES && ofSun && inMeshShadow(point)) weight = vec3(0.0);
    const int texel = START_TEXELS * int(place);
    imageStore(starts, texel, vec4(point, weight.x));
    imageStore(starts, texel + 1, vec4(direction, weight.y));
    imageStore(starts, texel + 2, vec4(weight.z, vec3(0.0)));
}
