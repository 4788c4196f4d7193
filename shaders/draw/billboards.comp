#version 460
#extension GL_GOOGLE_include_directive : require
// Billboards (Elek 2011, 5.9) as spheres that face the eye point: each pixel goes through its tile's list front to back,
// which is the same blending as back to front, and stops where nothing behind can be seen.
#include "shared/draw.h"
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
layout(binding = 7, scalar) readonly buffer Billboards { Billboard billboards[]; };
layout(binding = 8, scalar) readonly buffer TileOffsets { uint tileOffsets[]; };
layout(binding = 9, scalar) readonly buffer TileLists { uint tileLists[]; };

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, for every billboard.
DrawParams params;
#include "lib/stretch.glsl"

void addBillboard(inout RayLight ray, SunView sun, Billboard billboard, vec3 origin, vec3 direction) {
    const vec3 centre = billboard.centre - origin;
    const float along = dot(centre, direction);
    const vec3 closest = centre - along * direction;
    const float squared = billboard.radius * billboard.radius - dot(closest, closest);
    if (squared <= 0.0) return;
    const float halfChord = sqrt(squared);
    const float near = max(along - halfChord, 0.0), far = along + halfChord;
    if (far <= near) return;
    const float thickness = billboard.extinction * (far - near);
    const vec3 seen = origin + mix(near, far, seenAt(thickness, 0.5)) * direction;
    addStretch(ray, sun, near, far, thickness, params.field.eyeVoxel + params.field.worldToVoxel * seen,
               SUN ? max(billboard.sunDepth, sunDepthAt(params.field.eyeVoxel + params.field.worldToVoxel * seen)) : 0.0);
}

void main() {
    params = storedParams;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(params.firstColumn, params.firstRow);
    if (pixel.x >= params.firstColumn + params.columns || pixel.y >= params.firstRow + params.rows) return;
    const uint tile = uint((pixel.y / TILE_EDGE) * params.tilesAcross + pixel.x / TILE_EDGE);
    const uint last = tileOffsets[tile + 1u];
    const float opaque = opaqueDepth();
    PixelSum sum = emptyPixel();
    for (int part = 0; part < params.samples * params.samples; ++part) {
        vec3 origin, direction;
        viewRay(params.view, pixel * params.samples + ivec2(part % params.samples, part / params.samples),
                params.samples, origin, direction);
        const SunView sun = sunView(params.light, direction);
        RayLight ray = emptyRay();
        for (uint i = tileOffsets[tile]; i < last && ray.depth < opaque; ++i)
            addBillboard(ray, sun, billboards[tileLists[i]], origin, direction);
        addRay(sum, ray, direction);
    }
    pixels[(pixel.y - params.firstRow) * params.columns + pixel.x - params.firstColumn] =
        finishedPixel(sum, params.samples * params.samples);
}
