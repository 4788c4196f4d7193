#version 460
#extension GL_GOOGLE_include_directive : require
// Ray march through the density, front to back: cell by cell of the majorant grid, empty cells at once, others in steps
// that are bounded in length (a voxel) and in optical thickness, begun at an offset that differs from pixel to pixel.
#include "shared/draw.h"
#include "shared/rng.h"
#include "lib/density.glsl"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool FORWARD_CUT = false;
layout(constant_id = 1) const bool SUN = true;      // the sun shines
layout(constant_id = 2) const bool PHOTONS = true;  // there is a photon map
layout(constant_id = 3) const bool GREY = false;     // the albedo is the same for all colours

layout(binding = 0, scalar) readonly buffer Params { DrawParams storedParams; };
layout(binding = 1, scalar) readonly buffer PhaseTable { float phaseTable[]; };
layout(binding = 2, rgba32f) readonly uniform image2D singleScatterH;
layout(binding = 3, rgba32f) readonly uniform image2D singleScatterK;
layout(binding = 4) uniform sampler3D lightField;
layout(binding = 5) uniform sampler3D shadowVolume;
layout(binding = 6, scalar) writeonly buffer Pixels { Pixel pixels[]; };
layout(binding = 7) uniform sampler3D density;
layout(binding = 8, r32f) readonly uniform image3D majorants;  // normalised; negative: distances in empty space
layout(binding = 9, scalar) readonly buffer Blocks { uvec3 blockGroups; uint blockCount; uint blocks[]; };
layout(push_constant, scalar) uniform Push { DrawPush push; };

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, in every step.
DrawParams params;
#include "lib/drawn_pixel.glsl"
#include "lib/pixel.glsl"
#include "lib/ray_segment.glsl"

/// Optical thickness that a first step may have at most, by the cell's majorant.
const float STEP_THICKNESS = 0.5;
/// Steps grow with the cube root of what the cloud before them hides, where an error of theirs weighs less, up to so much.
const float GROWTH = 1.0 / 3.0, MOST_GROWTH = 4.0;

/// A view ray in voxels: start + velocity · metres.
struct ViewLine {
    vec3 start, velocity;
    vec3 inverse;  // of the velocity
    bvec3 ahead;
};

ViewLine viewLine(vec3 start, vec3 velocity) {
    const bvec3 aside = lessThan(abs(velocity), vec3(1.0e-30));  // never meets those faces
    velocity = mix(velocity, vec3(0.0), aside);
    return ViewLine(start, velocity, 1.0 / mix(velocity, vec3(1.0e-30), aside), greaterThan(velocity, vec3(0.0)));
}

/// Distances [m] between which the line is in the volume; empty where first >= second.
vec2 clipToVolume(ViewLine line) {
    const vec3 a = -line.start * line.inverse, b = (params.field.size - line.start) * line.inverse;
    const vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(high.x, min(high.y, high.z)));
}

/// From a cell over the `reach` next ones on all sides: the distance at which the line leaves them, and the cell there.
float leaveCells(ViewLine line, inout ivec3 cell, int reach) {
    const ivec3 beyond = cell + mix(ivec3(-reach - 1), ivec3(reach + 1), line.ahead);
    const vec3 face = vec3(cell + mix(ivec3(-reach), ivec3(reach + 1), line.ahead)) * params.field.cellSize;
    const vec3 distances =
        mix((face - line.start) * line.inverse, vec3(3.4e38), equal(line.velocity, vec3(0.0)));
    const float leave = min(distances.x, min(distances.y, distances.z));
    const vec3 end = floor((line.start + line.velocity * leave) / params.field.cellSize);
    cell = mix(clamp(ivec3(end), cell - reach, cell + reach), beyond, equal(distances, vec3(leave)));
    return leave;
}

/// Where a march is: the cell that the line leaves at `leave`, and the steps that are left in it.
struct Walk {
    ivec3 cell;
    float leave;        // of the last cell [m]; where the next one begins
    float begin, step;  // of the steps in it [m]
    float done, count;
    int crossed;        // cells
};

bool isOver(Walk walk, float end, ivec3 last) {
    return walk.leave >= end || walk.crossed >= 8192 || any(lessThan(walk.cell, ivec3(0))) ||
           any(greaterThan(walk.cell, last));
}

/// Goes through the next cell, or through empty ones: it has no steps then. `depth` is what hides it.
void enterCell(inout Walk walk, ViewLine line, float end, float depth) {
    const float majorant = imageLoad(majorants, walk.cell).r;
    walk.begin = walk.leave;
    walk.leave = max(leaveCells(line, walk.cell, int(max(-majorant - 1.0, 0.0))), walk.begin);
    const float span = min(walk.leave, end) - walk.begin;
    const float growth = min(exp(GROWTH * leastExtinctionScale() * depth), MOST_GROWTH);
    const float thickest = majorant * params.field.extinction / STEP_THICKNESS;
    const float steps = ceil(span * max(1.0 / params.field.voxelLength, thickest) / growth);
    walk.count = majorant > 0.0 && span > 0.0 ? clamp(steps, 1.0, 512.0) : 0.0;
    walk.step = span / max(walk.count, 1.0);
    walk.done = 0.0;
    ++walk.crossed;
}

/// The light of one ray; `offset` is where in its steps it looks. Cells, then steps, are gone through until one has
/// density, and only that is lit: lanes that have nothing to light would wait for those that have.
RayLight march(vec3 origin, vec3 direction, float offset) {
    const SunView sun = sunView(params.light, direction);
    const ViewLine line = viewLine(params.field.eyeVoxel + params.field.worldToVoxel * origin,
                                   params.field.worldToVoxel * direction);
    RayLight ray = emptyRay();
    const vec2 inside = clipToVolume(line);
    const float opaque = opaqueDepth();
    const ivec3 last = params.field.cells - 1;
    const ivec3 first = ivec3(floor((line.start + line.velocity * inside.x) / params.field.cellSize));
    Walk walk = Walk(clamp(first, ivec3(0), last), inside.x, inside.x, 0.0, 0.0, 0.0, 0);
    bool more = inside.x < inside.y;
    while (more) {
        float found = 0.0;
        while (more && found <= 0.0) {
            while (walk.done >= walk.count && !isOver(walk, inside.y, last)) enterCell(walk, line, inside.y, ray.depth);
            more = walk.done < walk.count;
            const float at = walk.begin + (walk.done + offset) * walk.step;
            found = more ? densityAt(density, line.start + line.velocity * at, 1.0 / params.field.size) : 0.0;
            walk.done += 1.0;
        }
        if (found > 0.0) {
            const float near = walk.begin + (walk.done - 1.0) * walk.step;
            const float thickness = found * params.field.extinction * walk.step;
            const vec3 seen = line.start + line.velocity * (near + seenAt(thickness, offset) * walk.step);
            addSegment(ray, sun, near, near + walk.step, thickness, seen, SUN ? depthToSun(seen) : 0.0);
        }
        more = more && ray.depth < opaque;
    }
    return ray;
}

void main() {
    params = storedParams;
    ivec2 pixel;
    int slot;
    if (!drawnPixel(pixel, slot)) return;
    PixelSum sum = emptyPixel();
    for (int i = 0; i < params.samples * params.samples; ++i) {
        const ivec2 fine = pixel * params.samples + ivec2(i % params.samples, i / params.samples);
        vec3 origin, direction;
        viewRay(params.view, fine, params.samples, origin, direction);
        // interleaved gradient noise (Jimenez 2014): neighbours differ as much as they can
        const float offset = fract(52.9829189 * fract(dot(vec2(fine) + 0.5, vec2(0.06711056, 0.00583715))));
        addRay(sum, march(origin, direction, offset), direction);
    }
    const Pixel finished = finishedPixel(sum, params.samples * params.samples);
    STORE_PIXEL(pixels, slot, finished);
}
