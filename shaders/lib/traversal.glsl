// How everything that travels through a cloud travels: from cell to cell of its grid of majorants. What happens on the way is
// not known here. Photons walk from collision to collision (Walk): their position is a cell and an offset in it, since at
// optical depths of 1e5 and more, steps in coordinates of the whole volume would round by percents. View rays and columns of
// shadow volumes go along a line from one distance to the next (Line): their position is a distance, by which what they meet
// in several instances is put in order (lib/instances.glsl). Cells without density hold, as a negative number, the distance
// in cells to the nearest one that has some: all nearer ones are crossed at once.
#ifndef LUMULUS_LIB_TRAVERSAL
#define LUMULUS_LIB_TRAVERSAL

/// Cells around one of this majorant that are empty too.
int emptyReach(float majorant) { return int(max(-majorant - 1.0, 0.0)); }

/// A straight line in voxel coordinates: start + velocity · metres.
struct Line {
    vec3 start, velocity;
    vec3 inverse;  // of the velocity
    bvec3 ahead;
};

Line lineFrom(vec3 start, vec3 velocity) {
    const bvec3 aside = lessThan(abs(velocity), vec3(1.0e-30));  // never meets those faces
    velocity = mix(velocity, vec3(0.0), aside);
    return Line(start, velocity, 1.0 / mix(velocity, vec3(1.0e-30), aside), greaterThan(velocity, vec3(0.0)));
}

/// Distances [m] between which the line is in a volume of `size` voxels; empty where first >= second.
vec2 clipToVolume(Line line, vec3 size) {
    const vec3 a = -line.start * line.inverse, b = (size - line.start) * line.inverse;
    const vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(high.x, min(high.y, high.z)));
}

/// From a cell over the `reach` next ones on all sides: the distance at which the line leaves them, and the cell there.
float leaveCells(Line line, inout ivec3 cell, int reach, vec3 cellSize) {
    const ivec3 beyond = cell + mix(ivec3(-reach - 1), ivec3(reach + 1), line.ahead);
    const vec3 face = vec3(cell + mix(ivec3(-reach), ivec3(reach + 1), line.ahead)) * cellSize;
    const vec3 distances =
        mix((face - line.start) * line.inverse, vec3(3.4e38), equal(line.velocity, vec3(0.0)));
    const float leave = min(distances.x, min(distances.y, distances.z));
    const vec3 end = floor((line.start + line.velocity * leave) / cellSize);
    cell = mix(clamp(ivec3(end), cell - reach, cell + reach), beyond, equal(distances, vec3(leave)));
    return leave;
}

const uint WALK_CROSSED = 0u;    // into the next cell
const uint WALK_COLLISION = 1u;  // a tentative collision
const uint WALK_LEFT = 2u;       // out of the grid

struct Walk {
    ivec3 cell;
    vec3 offset;    // in the cell, 0…1
    vec3 velocity;  // cells per metre
    vec3 slowness;  // its reciprocal
    float depth;    // optical depth left
};

void setVelocity(inout Walk walk, vec3 velocity) {
    walk.velocity = velocity;
    walk.slowness = 1.0 / velocity;
}

Walk makeWalk(ivec3 cell, vec3 offset, vec3 velocity, float depth) {
    return Walk(cell, offset, velocity, 1.0 / velocity, depth);
}

/// Optical depth to the next tentative collision; u in [0,1).
float opticalDepth(float u) { return -log(1.0 - u); }

/// Goes on to the next collision, or out of the walk's cell and so many on each side of it, which all have this majorant
/// [1/m]. At a collision the walk stays where it was: stepToCollision() goes there.
uint leaveBox(inout Walk walk, float majorant, vec3 below, vec3 above) {
    const bvec3 ahead = greaterThan(walk.velocity, vec3(0.0));
    const vec3 face = mix(-below, 1.0 + above, ahead);
    const vec3 distances =
        mix((face - walk.offset) * walk.slowness, vec3(3.4e38), equal(walk.velocity, vec3(0.0)));
    const float nearest = max(min(distances.x, min(distances.y, distances.z)), 0.0);
    const float crossing = majorant * nearest;
    if (walk.depth < crossing) return WALK_COLLISION;
    walk.depth -= crossing;
    const vec3 end = walk.offset + walk.velocity * nearest;
    const bvec3 met = bvec3(distances.x <= nearest, distances.x > nearest && distances.y <= nearest,
                            distances.x > nearest && distances.y > nearest);
    const vec3 passed = mix(clamp(floor(end), -below, above), mix(-1.0 - below, 1.0 + above, ahead), met);
    walk.offset = mix(clamp(end - passed, 0.0, 1.0), 1.0 - vec3(ahead), met);
    walk.cell += ivec3(passed);
    return WALK_CROSSED;
}

bool isInside(Walk walk, ivec3 cells) {
    return all(greaterThanEqual(walk.cell, ivec3(0))) && all(lessThan(walk.cell, cells));
}

/// Goes on to the next collision or cell face. `majorant` is that of the walk's cell [1/m], or where it is negative
/// the distance, in cells, to the nearest cell that is not empty: all nearer ones are crossed at once. A periodic grid
/// goes on for ever in x and z. At a collision the walk stays where it was.
uint walkStep(inout Walk walk, float majorant, ivec3 cells, bool periodic) {
    const vec3 reach = vec3(max(-majorant - 1.0, 0.0));
    if (leaveBox(walk, max(majorant, 0.0), reach, reach) == WALK_COLLISION) return WALK_COLLISION;
    if (periodic) walk.cell.xz = (walk.cell.xz + cells.xz) % cells.xz;
    return isInside(walk, cells) ? WALK_CROSSED : WALK_LEFT;
}

/// To the collision that walkStep() found in a cell of this majorant.
void stepToCollision(inout Walk walk, float majorant) {
    walk.offset = clamp(walk.offset + walk.velocity * (walk.depth / majorant), 0.0, 1.0);
}

#endif
