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
// As images: their loads are by vectors on lavapipe, those from buffers by lanes.
layout(binding = 7) uniform sampler2D billboards;  // two texels each
layout(binding = 8, scalar) readonly buffer TileOffsets { uint tileOffsets[]; };
layout(binding = 9) uniform usampler2D tileLists;
layout(binding = 10, scalar) readonly buffer Blocks { uvec3 blockGroups; uint blockCount; uint blocks[]; };
layout(push_constant, scalar) uniform Push { DrawPush push; };

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, for every billboard.
DrawParams params;
#include "lib/drawn_pixel.glsl"
#include "lib/stretch.glsl"

Billboard billboardAt(uint entry) {
    const int number = int(texelFetch(tileLists, ivec2(entry % LIST_WIDTH, entry / LIST_WIDTH), 0).r);
    const ivec2 place = ivec2(2 * number % LIST_WIDTH, 2 * number / LIST_WIDTH);
    const vec4 sphere = texelFetch(billboards, place, 0);
    const vec4 rest = texelFetch(billboards, place + ivec2(1, 0), 0);
    return Billboard(sphere.xyz, sphere.w, rest.x, rest.y);
}

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
    ivec2 pixel;
    int slot;
    if (!drawnPixel(pixel, slot)) return;
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
            addBillboard(ray, sun, billboardAt(i), origin, direction);
        addRay(sum, ray, direction);
    }
    pixels[slot] = finishedPixel(sum, params.samples * params.samples);
}
