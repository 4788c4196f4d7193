// The ground below the clouds, as photons meet it: it sends the light of sun and sky up to them, and what leaves them
// downwards it counts and sends back. The includer declares `params` and the constant GROUND.
#ifndef LUMULUS_LIB_GROUND
#define LUMULUS_LIB_GROUND

#include "lib/environment_sample.glsl"
#include "lib/ground_light.glsl"
#include "lib/photon.glsl"
#include "lib/traversal.glsl"

/// Counts light that falls on the ground.
void countOnGround(vec2 place, vec3 power) {
    const int cell = groundCell(place, ivec2(GROUND_COUNTS));
    if (cell < 0) return;
    for (int channel = 0; channel < 3; ++channel)
        atomicAdd(estimates[ground.countBase + uint(3 * cell + channel)],
                  int64_t(roundEven(COEFFICIENT_SCALE * power[channel])));
}

/// What fog does to light on its way between a place of the walk and the ground.
void passFogBelow(inout TraceState state, vec3 place) {
    state.weight *= throughFogBelow(airPlace(params.air, place * params.cellSize).y, state.direction.y);
}

/// The light that a photon has where it is first scattered, against that which it began with. In fog, light from below is
/// that of a ground without shadows: those of the clouds are seen through the fog as far as it leaves directions as they are.
vec3 firstLightAt(bool ofSun, TraceState state, vec3 voxel) {
    const vec2 place = airPlace(params.air, voxel);
    vec3 light = firstLight(ofSun, params.skyAxes, state.direction, place);
    if (FOG && GROUND && !ofSun && state.direction.y > 0.0) {
        const vec3 share = skyOrGround(voxel / params.cellSize, state.direction) / max(ground.open, vec3(1.0e-30));
        light *= mix(vec3(1.0), share, throughFogBelow(place.y, state.direction.y));
    }
    return light;
}

/// The same of light that leaves the clouds; it may have been scattered nowhere.
void leaveThroughFog(inout TraceState state, vec3 place) {
    if (state.scatterings == 0u) {
        state.weight *= firstLightAt(state.photon < params.sunPhotons, state, place * params.cellSize);
        ++state.scatterings;
    }
    passFogBelow(state, place);
}

/// Takes a photon that has left the clouds to the ground and back. False: it does not come back.
bool bounce(inout TraceState state, inout Walk walk, vec3 lightPower) {
    if (state.direction.y >= 0.0) return false;
    const vec3 left = vec3(walk.cell) + walk.offset, above = overGround(left);
    const float metres = above.y / -state.direction.y;  // back, where the walk's cells reach below the ground
    if (FOG) leaveThroughFog(state, left);
    countOnGround(above.xz + metres * state.direction.xz, lightPower * state.weight);
    const vec4 u = draw(state);
    if (!survives(state, ground.albedo, u.x)) return false;
    const vec3 hit = left + metres * walk.velocity;
    const float sine = sqrt(u.y), azimuth = 6.28318531 * u.z;
    state.direction = vec3(sine * cos(azimuth), sqrt(1.0 - u.y), sine * sin(azimuth));
    setVelocity(walk, params.worldToCells * state.direction);
    const Line line = lineFrom(hit, walk.velocity);
    const vec2 inside = clipToVolume(line, vec3(params.cells));
    if (inside.x >= inside.y) return false;
    const vec3 entry = hit + inside.x * walk.velocity;
    if (FOG) passFogBelow(state, entry);
    walk.cell = clamp(ivec3(floor(entry)), ivec3(0), params.cells - 1);
    walk.offset = clamp(entry - vec3(walk.cell), 0.0, 1.0);
    return true;
}

#endif
