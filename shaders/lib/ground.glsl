// The ground below the clouds, as photons meet it: it sends the light of sun and sky up to them, and what leaves them
// downwards it counts and sends back. The includer declares `params` and the constant GROUND.
#ifndef LUMULUS_LIB_GROUND
#define LUMULUS_LIB_GROUND

#include "shared/ground.h"
#include "lib/photon.glsl"
#include "lib/traversal.glsl"

layout(binding = 20, scalar) readonly buffer GroundLight { GroundParams ground; vec3 groundRadiance[]; };

/// Of a place of the walk [cells]: metres from the corner of the grids on the ground along x and z, and above the ground.
vec3 overGround(vec3 place) { return ground.cellsToWorld * place + ground.origin; }

/// The cell of a grid over the ground in which a place is; −1 where none is.
int groundCell(vec2 place, ivec2 cells) {
    const vec2 cell = floor(place / ground.extent * vec2(cells));
    if (any(lessThan(cell, vec2(0.0))) || any(greaterThanEqual(cell, vec2(cells)))) return -1;
    return int(cell.y) * cells.x + int(cell.x);
}

/// Light that comes from a direction to a place of the walk, over what photons of the sky stand for: of the ground without the
/// light of clouds, or of the sky.
vec3 skyOrGround(vec3 place, vec3 direction) {
    if (direction.y <= 0.0) return ground.sky;
    const vec3 above = overGround(place);
    const vec2 hit = above.xz - direction.xz * (above.y / direction.y);
    const int cell = groundCell(hit, ground.cells);
    return cell < 0 ? ground.open : groundRadiance[cell];
}

/// Counts light that falls on the ground.
void countOnGround(vec2 place, vec3 power) {
    const int cell = groundCell(place, ivec2(GROUND_COUNTS));
    if (cell < 0) return;
    for (int channel = 0; channel < 3; ++channel)
        atomicAdd(estimates[ground.countBase + uint(3 * cell + channel)],
                  int64_t(roundEven(COEFFICIENT_SCALE * power[channel])));
}

/// Takes a photon that has left the clouds to the ground and back. False: it does not come back.
bool bounce(inout TraceState state, inout Walk walk, vec3 lightPower) {
    if (state.direction.y >= 0.0) return false;
    const vec3 left = vec3(walk.cell) + walk.offset, above = overGround(left);
    const float metres = above.y / -state.direction.y;  // back, where the walk's cells reach below the ground
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
    walk.cell = clamp(ivec3(floor(entry)), ivec3(0), params.cells - 1);
    walk.offset = clamp(entry - vec3(walk.cell), 0.0, 1.0);
    return true;
}

#endif
