// Delta (Woodcock) tracking through a grid of majorants, one cell at a time. The position is a cell and an offset in it:
// at optical depths of 1e5 and more, steps in coordinates of the whole volume would round by percents.
// The walk knows nothing of what happens at a collision: photons and transmittance share it.
#ifndef LUMULUS_LIB_TRACKING
#define LUMULUS_LIB_TRACKING

const uint WALK_CROSSED = 0u;    // into the next cell
const uint WALK_COLLISION = 1u;  // a tentative collision
const uint WALK_LEFT = 2u;       // out of the grid

struct Walk {
    ivec3 cell;
    vec3 offset;    // in the cell, 0…1
    vec3 velocity;  // cells per metre
    float depth;    // optical depth left
};

/// Goes on to the next collision or cell face; `majorant` is that of the walk's cell [1/m]. A periodic grid goes on for
/// ever in x and z.
uint walkStep(inout Walk walk, float majorant, ivec3 cells, bool periodic) {
    const vec3 face = vec3(greaterThan(walk.velocity, vec3(0.0)));
    const bvec3 moves = notEqual(walk.velocity, vec3(0.0));
    const vec3 distances = mix(vec3(3.4e38), (face - walk.offset) / walk.velocity, moves);
    const float nearest = max(min(distances.x, min(distances.y, distances.z)), 0.0);
    const float crossing = majorant * nearest;
    if (walk.depth < crossing) {
        walk.offset = clamp(walk.offset + walk.velocity * (walk.depth / majorant), 0.0, 1.0);
        return WALK_COLLISION;
    }
    walk.depth -= crossing;
    walk.offset = clamp(walk.offset + walk.velocity * nearest, 0.0, 1.0);
    const int axis = distances.x <= nearest ? 0 : (distances.y <= nearest ? 1 : 2);
    const int direction = walk.velocity[axis] > 0.0 ? 1 : -1;
    walk.cell[axis] += direction;
    walk.offset[axis] = direction > 0 ? 0.0 : 1.0;
    if (periodic && axis != 1) walk.cell[axis] = (walk.cell[axis] + cells[axis]) % cells[axis];
    return walk.cell[axis] < 0 || walk.cell[axis] >= cells[axis] ? WALK_LEFT : WALK_CROSSED;
}

#endif
