#version 460
#extension GL_GOOGLE_include_directive : require
// Ray march through the density, front to back: cell by cell of the majorant grid, empty cells at once, others in steps
// that are bounded in length (a voxel) and in optical thickness, begun at an offset that differs from pixel to pixel.
#include "shared/draw.h"
#include "shared/mesh.h"
#include "shared/rng.h"
#include "lib/density.glsl"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool FORWARD_CUT = false;
layout(constant_id = 1) const bool SUN = true;      // the sun shines
layout(constant_id = 2) const bool PHOTONS = true;  // there is a photon map
layout(constant_id = 4) const bool MANY = false;     // more than one instance
layout(constant_id = 5) const bool AIR = false;      // an atmosphere: the sun's light differs by place
layout(constant_id = 6) const bool GROUND = false;   // rays end at the ground
layout(constant_id = 7) const bool THICK = false;    // voxels are so thick that the sun's light differs within one
layout(constant_id = 10) const bool MESH = false;    // rays end at meshes
layout(constant_id = 3) const bool GREY = false;     // albedo and phase function are the same for all colours
layout(constant_id = 8) const bool COLOURED = false; // the phase function of a cloud differs between colours

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
layout(binding = 13) uniform sampler2D sunColours;
layout(binding = 17, scalar) readonly buffer TileDetail { uint tileDetail[]; };
layout(binding = 18, scalar) readonly buffer MeshPixels { MeshPixel meshPixels[]; };  // of the rectangle
layout(binding = 19, scalar) readonly buffer MeshEdges { float meshEdges[]; };
layout(push_constant, scalar) uniform Push { DrawPush push; };

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, in every step.
DrawParams params;
#include "lib/drawn_pixel.glsl"
#include "lib/pixel.glsl"
#include "lib/ray_segment.glsl"
#include "lib/instance_tiles.glsl"
#include "lib/tile_detail.glsl"
#include "lib/near_sun.glsl"

/// Optical thickness that a first step may have at most, by the cell's majorant.
const float STEP_THICKNESS = 0.5;
/// Steps grow with the cube root of what the cloud before them hides, where an error of theirs weighs less, up to so much.
const float GROWTH = 1.0 / 3.0, MOST_GROWTH = 4.0;

/// Where a march is: the cell that the line leaves at `leave`, and the steps that are left in it.
struct March {
    ivec3 cell;
    float leave;        // of the last cell [m]; where the next one begins
    float begin, step;  // of the steps in it [m]
    float done, count;
    int crossed;        // cells
};

bool isOver(March walk, float end, ivec3 last) {
    return walk.leave >= end || walk.crossed >= 8192 || any(lessThan(walk.cell, ivec3(0))) ||
           any(greaterThan(walk.cell, last));
}

/// Goes through the next cell, or through empty ones: it has no steps then. `depth` is what hides it.
void enterCell(inout March walk, InstanceParams instance, Line line, float end, float depth) {
    const float majorant = imageLoad(majorants, MANY ? instance.cellOrigin + walk.cell : walk.cell).r;
    walk.begin = walk.leave;
    walk.leave = max(leaveCells(line, walk.cell, emptyReach(majorant), instance.cellSize), walk.begin);
    const float span = min(walk.leave, end) - walk.begin;
    const float growth = min(exp(GROWTH * leastExtinctionScale(instance) * depth), MOST_GROWTH);
    const float thickest = majorant * instance.extinction / STEP_THICKNESS;
    // voxels a metre; of flat ones by the direction
    const float finest = instance.voxelLength > 0.0 ? 1.0 / instance.voxelLength : length(line.velocity);
    const float steps = ceil(span * max(finest, thickest) / growth);
    walk.count = majorant > 0.0 && span > 0.0 ? clamp(steps, 1.0, 512.0) : 0.0;
    walk.step = span / max(walk.count, 1.0);
    walk.done = 0.0;
    ++walk.crossed;
}

/// Adds the light of a ray between two distances in one instance; `offset` is where in its steps it looks. Cells, then steps,
/// are gone through until one has density, and only that is lit: lanes that have nothing to light would wait for those that
/// have.
void marchThrough(InstanceParams instance, vec3 direction, Line line, vec2 inside, float offset, inout RayLight ray) {
    const SunView sun = sunView(instance, direction);
    const float opaque = opaqueDepth(instance);
    const ivec3 last = instance.cells - 1;
    const ivec3 first = ivec3(floor((line.start + line.velocity * inside.x) / instance.cellSize));
    March walk = March(clamp(first, ivec3(0), last), inside.x, inside.x, 0.0, 0.0, 0.0, 0);
    bool more = inside.x < inside.y;
    while (more) {
        float found = 0.0;
        while (more && found <= 0.0) {
            while (walk.done >= walk.count && !isOver(walk, inside.y, last))
                enterCell(walk, instance, line, inside.y, ray.depth);
            more = walk.done < walk.count;
            const float at = walk.begin + (walk.done + offset) * walk.step;
            found = more ? densityIn(instance, density, line.start + line.velocity * at) : 0.0;
            walk.done += 1.0;
        }
        if (found > 0.0) {
            const float near = walk.begin + (walk.done - 1.0) * walk.step;
            const float thickness = found * instance.extinction * walk.step;
            const vec3 seen = line.start + line.velocity * (near + seenAt(thickness, offset) * walk.step);
            addSegment(ray, instance, sun, near, near + walk.step, thickness, seen,
                       SUN ? depthToSunNear(instance, seen, ray.depth) : 0.0);
        }
        if (MANY)
            more = more && !isOpaque(ray);
        else
            more = more && ray.depth < opaque;
    }
}

/// Metres to the ground along a ray.
float distanceToGround(vec3 origin, vec3 direction) {
    const float above = params.eyeAboveGround + origin.y;
    return direction.y < 0.0 ? max(above, 0.0) / -direction.y : 3.4e38;
}

/// The light of one ray: through the one instance, or through those of a list, segment by segment. `solid`: metres to a mesh.
RayLight march(InstanceRange range, vec3 origin, vec3 direction, float offset, float solid) {
    RayLight ray = emptyRay();
    if (!MANY) {
        const Line line = lineIn(onlyInstance, origin, direction);
        vec2 inside = clipToVolume(line, onlyInstance.size);
        if (GROUND) inside.y = min(inside.y, distanceToGround(origin, direction));
        if (MESH) inside.y = min(inside.y, solid);
        marchThrough(onlyInstance, direction, line, inside, offset, ray);
        return ray;
    }
    float limit = GROUND ? distanceToGround(origin, direction) : 3.4e38;
    if (MESH) limit = min(limit, solid);
    float begin = 0.0, end = segmentEnd(range, origin, direction, begin);
    while (end > begin && !isOpaque(ray) && (!(GROUND || MESH) || begin < limit)) {
        if (GROUND || MESH) end = min(end, limit);
        // lanes look for the next instance that they meet, and go through it together
        int entry = range.first;
        while (entry < range.last) {
            int number = -1;
            while (number < 0 && entry < range.last) {
                const Listed listed = listedInstance(entry++);
                if (listed.nearest > begin) {
                    entry = range.last;
                    break;
                }
                float voxelLength;
                const vec2 inside = insideOf(listed.instance, origin, direction, voxelLength);
                if (inside.x < inside.y && inside.x <= begin && inside.y > begin) number = listed.instance;
            }
            const InstanceParams instance = instanceAt(max(number, 0));
            const float until = number < 0 ? begin : end;
            marchThrough(instance, direction, lineIn(instance, origin, direction), vec2(begin, until), offset, ray);
        }
        begin = end;
        end = segmentEnd(range, origin, direction, begin);
    }
    return ray;
}

void main() {
    params = storedParams;
    loadInstances();
    ivec2 pixel;
    int slot;
    if (!drawnPixel(pixel, slot)) return;
    InstanceRange range = InstanceRange(0, 0);
    int samples = params.samples;
    if (MANY) {
        range = instancesOf(pixel);
        samples = raysAt(pixel);
    }
    MeshPixel mesh = MeshPixel(vec3(0.0), FAR_DEPTH, -1);
    if (MESH) {
        mesh = meshPixels[slot];
        if (mesh.edge >= 0) samples = MESH_EDGE_RAYS;
    }
    PixelSum sum = emptyPixel();
    for (int i = 0; i < samples * samples; ++i) {
        const ivec2 fine = pixel * samples + ivec2(i % samples, i / samples);
        vec3 origin, direction;
        viewRay(params.view, fine, samples, origin, direction);
        // interleaved gradient noise (Jimenez 2014): neighbours differ as much as they can
        const float offset = fract(52.9829189 * fract(dot(vec2(fine) + 0.5, vec2(0.06711056, 0.00583715))));
        float solid = mesh.distance;
        if (MESH && mesh.edge >= 0) solid = meshEdges[samples * samples * mesh.edge + i];
        const RayLight ray = march(range, origin, direction, offset, solid);
        if (MESH && solid < FAR_DEPTH)
            addRayToMesh(sum, ray, solid, mesh.radiance);
        else
            addRay(sum, ray, direction);
    }
    const Pixel finished = finishedPixel(sum, samples * samples);
    STORE_PIXEL(pixels, slot, finished);
}
