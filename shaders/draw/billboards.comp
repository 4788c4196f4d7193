#version 460
#extension GL_GOOGLE_include_directive : require
// Billboards (Elek 2011, 5.9) as spheres that face the eye point: each pixel goes through its tile's list front to back,
// which is the same blending as back to front, and stops where nothing behind can be seen. What a ray goes through of a
// sphere has the cloud's own density in the middle of it: a sphere that stands out of the cloud is not seen there.
#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool FORWARD_CUT = false;
layout(constant_id = 1) const bool SUN = true;      // the sun shines
layout(constant_id = 2) const bool PHOTONS = true;  // there is a photon map
layout(constant_id = 4) const bool MANY = false;     // more than one instance
layout(constant_id = 5) const bool AIR = false;      // an atmosphere: the sun's light differs by place
layout(constant_id = 3) const bool GREY = false;     // albedo and phase function are the same for all colours
layout(constant_id = 8) const bool COLOURED = false; // the phase function of a cloud differs between colours

layout(binding = 0, scalar) readonly buffer Params { DrawParams storedParams; };
layout(binding = 1, scalar) readonly buffer PhaseTable { float phaseTable[]; };
layout(binding = 2, rgba32f) readonly uniform image2D singleScatterH;
layout(binding = 3, rgba32f) readonly uniform image2D singleScatterK;
layout(binding = 4) uniform sampler3D lightField;
layout(binding = 5) uniform sampler3D shadowVolume;
layout(binding = 6, scalar) writeonly buffer Pixels { Pixel pixels[]; };
// As images: their loads are by vectors on lavapipe, those from buffers by lanes.
layout(binding = 7, rgba32f) readonly uniform image2D billboards;  // two texels each
layout(binding = 8, scalar) readonly buffer TileOffsets { uint tileOffsets[]; };
layout(binding = 9, r32ui) readonly uniform uimage2D tileLists;
layout(binding = 10, scalar) readonly buffer Blocks { uvec3 blockGroups; uint blockCount; uint blocks[]; };
layout(binding = 11) uniform sampler3D density;
layout(binding = 13) uniform sampler2D sunColours;
layout(push_constant, scalar) uniform Push { DrawPush push; };

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe, for every billboard.
DrawParams params;
#include "lib/drawn_pixel.glsl"
#include "lib/pixel.glsl"
#include "lib/ray_segment.glsl"

/// What a ray goes through of a billboard.
struct Chord {
    ivec2 place;  // texel of the billboard
    float near, far;
};

bool isHit(Chord chord) { return chord.far > chord.near; }

Chord chordThrough(uint entry, vec3 origin, vec3 direction) {
    const uint number = imageLoad(tileLists, ivec2(entry % uint(LIST_WIDTH), entry / uint(LIST_WIDTH))).r;
    const ivec2 place = ivec2(2u * number % uint(LIST_WIDTH), 2u * number / uint(LIST_WIDTH));
    const vec4 sphere = imageLoad(billboards, place);
    const vec3 centre = sphere.xyz - origin;
    const float along = dot(centre, direction);
    const vec3 closest = centre - along * direction;
    const float squared = sphere.w * sphere.w - dot(closest, closest);
    const float halfChord = sqrt(max(squared, 0.0));
    return Chord(place, max(along - halfChord, 0.0), squared > 0.0 ? along + halfChord : 0.0);
}

vec3 voxelAlong(InstanceParams instance, vec3 origin, vec3 direction, float distance) {
    return instance.eyeVoxel + instance.worldToVoxel * (origin + distance * direction);
}

void addChord(inout RayLight ray, SunView sun, Chord chord, vec3 origin, vec3 direction) {
    const vec2 billboard = imageLoad(billboards, chord.place + ivec2(1, 0)).xy;  // share, instance
    const InstanceParams instance = instanceAt(int(billboard.y));
    if (MANY) sun = sunView(instance, direction);
    const vec3 middle = voxelAlong(instance, origin, direction, 0.5 * (chord.near + chord.far));
    const float found = densityIn(instance, density, middle);
    const float thickness = instance.extinction * billboard.x * found * (chord.far - chord.near);
    const vec3 seen = voxelAlong(instance, origin, direction, mix(chord.near, chord.far, seenAt(thickness, 0.5)));
    addSegment(ray, instance, sun, chord.near, chord.far, thickness, seen, SUN ? depthToSun(instance, seen) : 0.0);
}

/// Through the list from `next` to `last`. The billboard that is met next is looked for first and lit only then: lanes that
/// have nothing to light would wait for those that have.
RayLight throughList(uint next, uint last, SunView sun, vec3 origin, vec3 direction) {
    RayLight ray = emptyRay();
    const float opaque = opaqueDepth(onlyInstance);
    while (next < last && (MANY ? !isOpaque(ray) : ray.depth < opaque)) {
        Chord chord = chordThrough(next++, origin, direction);
        while (!isHit(chord) && next < last) chord = chordThrough(next++, origin, direction);
        if (isHit(chord)) addChord(ray, sun, chord, origin, direction);
    }
    return ray;
}

void main() {
    params = storedParams;
    loadInstances();
    ivec2 pixel;
    int slot;
    if (!drawnPixel(pixel, slot)) return;
    const uint tile = uint((pixel.y / TILE_EDGE) * params.tilesAcross + pixel.x / TILE_EDGE);
    const uint last = tileOffsets[tile + 1u];
    PixelSum sum = emptyPixel();
    for (int part = 0; part < params.samples * params.samples; ++part) {
        vec3 origin, direction;
        viewRay(params.view, pixel * params.samples + ivec2(part % params.samples, part / params.samples),
                params.samples, origin, direction);
        SunView sun;
        if (!MANY) sun = sunView(onlyInstance, direction);
        addRay(sum, throughList(tileOffsets[tile], last, sun, origin, direction), direction);
    }
    const Pixel finished = finishedPixel(sum, params.samples * params.samples);
    STORE_PIXEL(pixels, slot, finished);
}
