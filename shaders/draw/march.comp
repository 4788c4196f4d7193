#version 460
#extension GL_GOOGLE_include_directive : require
// Ray march through the density, front to back: cell by cell of the majorant grid, empty cells at once, others in steps
// that are bounded in length (a voxel) and in optical thickness, begun at an offset that differs from pixel to pixel.
#include "shared/draw.h"
#include "shared/rng.h"
#include "lib/density.glsl"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool ONE_TURN = false;
layout(constant_id = 1) const bool SUN = true;      // the sun shines
layout(constant_id = 2) const bool PHOTONS = true;  // there is a photon map
layout(constant_id = 3) const bool GREY = false;     // the albedo is the same for all colours

layout(binding = 0, scalar) readonly buffer Params { DrawParams storedParams; };
layout(binding = 1, scalar) readonly buffer PhaseTable { float phaseTable[]; };
layout(binding = 2) uniform sampler2D oneTurnH;
layout(binding = 3) uniform sampler2D oneTurnK;
layout(binding = 4) uniform sampler3D lightField;
layout(binding = 5) uniform sampler3D sunDepth;
layout(binding = 6, scalar) writeonly buffer Pixels { Pixel pixels[]; };
layout(binding = 7) uniform sampler3D density;
layout(binding = 8, scalar) readonly buffer Majorants { float majorants[]; };

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, in every step.
DrawParams params;
#include "lib/stretch.glsl"

/// Optical thickness that a step may have at most, by the cell's majorant.
const float STEP_THICKNESS = 0.25;

/// Distances [m] between which the ray is in the volume; empty where first >= second.
vec2 clipToVolume(vec3 start, vec3 velocity) {
    const vec3 inverse = 1.0 / mix(velocity, vec3(1.0e-30), equal(velocity, vec3(0.0)));
    const vec3 a = -start * inverse, b = (params.field.size - start) * inverse;
    const vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(high.x, min(high.y, high.z)));
}

/// Distance at which the ray leaves its cell.
float cellExit(vec3 start, vec3 velocity, ivec3 cell) {
    const vec3 face = (vec3(cell) + vec3(greaterThan(velocity, vec3(0.0)))) * params.field.cellSize;
    const vec3 distances = mix((face - start) / velocity, vec3(3.4e38), equal(velocity, vec3(0.0)));
    return min(distances.x, min(distances.y, distances.z));
}

void marchCell(inout RayLight ray, SunView sun, vec3 start, vec3 velocity, vec2 span, float majorant, float offset) {
    const float length_ = span.y - span.x;
    const float steps = ceil(max(length_ / params.field.voxelLength, length_ * majorant / STEP_THICKNESS));
    const float count = clamp(steps, 1.0, 512.0);
    const float dt = length_ / count;
    for (float i = 0.0; i < count; i += 1.0) {
        const float near = span.x + i * dt;
        const float found = densityAt(density, start + velocity * (near + offset * dt), 1.0 / params.field.size);
        if (found > 0.0) {
            const float thickness = found * params.field.extinction * dt;
            const vec3 seen = start + velocity * (near + seenAt(thickness, offset) * dt);
            addStretch(ray, sun, near, near + dt, thickness, seen, SUN ? sunDepthAt(seen) : 0.0);
        }
    }
}

/// The light of one ray; `offset` is where in its steps it looks.
RayLight march(vec3 origin, vec3 direction, float offset) {
    const SunView sun = sunView(params.light, direction);
    const vec3 start = params.field.eyeVoxel + params.field.worldToVoxel * origin;
    const vec3 velocity = params.field.worldToVoxel * direction;
    RayLight ray = emptyRay();
    const vec2 inside = clipToVolume(start, velocity);
    const float opaque = opaqueDepth();
    const ivec3 last = params.field.cells - 1;
    float t = inside.x;
    ivec3 cell = clamp(ivec3(floor((start + velocity * t) / params.field.cellSize)), ivec3(0), last);
    for (int crossed = 0; crossed < 8192 && t < inside.y && ray.depth < opaque; ++crossed) {
        const float leave = max(cellExit(start, velocity, cell), t);
        const float majorant = params.field.extinction *
                               majorants[(cell.z * params.field.cells.y + cell.y) * params.field.cells.x + cell.x];
        if (majorant > 0.0 && leave > t)
            marchCell(ray, sun, start, velocity, vec2(t, min(leave, inside.y)), majorant, offset);
        // on to the neighbour through the face that is met
        const vec3 face = (vec3(cell) + vec3(greaterThan(velocity, vec3(0.0)))) * params.field.cellSize;
        const vec3 distances = mix((face - start) / velocity, vec3(3.4e38), equal(velocity, vec3(0.0)));
        const int axis = distances.x <= leave ? 0 : (distances.y <= leave ? 1 : 2);
        cell[axis] += velocity[axis] > 0.0 ? 1 : -1;
        if (any(lessThan(cell, ivec3(0))) || any(greaterThan(cell, last))) break;
        t = leave;
    }
    return ray;
}

void main() {
    params = storedParams;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(params.firstColumn, params.firstRow);
    if (pixel.x >= params.firstColumn + params.columns || pixel.y >= params.firstRow + params.rows) return;
    PixelSum sum = emptyPixel();
    for (int i = 0; i < params.samples * params.samples; ++i) {
        const ivec2 fine = pixel * params.samples + ivec2(i % params.samples, i / params.samples);
        vec3 origin, direction;
        viewRay(params.view, fine, params.samples, origin, direction);
        // interleaved gradient noise (Jimenez 2014): neighbours differ as much as they can
        const float offset = fract(52.9829189 * fract(dot(vec2(fine) + 0.5, vec2(0.06711056, 0.00583715))));
        addRay(sum, march(origin, direction, offset), direction);
    }
    pixels[(pixel.y - params.firstRow) * params.columns + pixel.x - params.firstColumn] =
        finishedPixel(sum, params.samples * params.samples);
}
