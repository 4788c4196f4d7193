#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the shadows of meshes to a shadow volume of a cloud: the optical depth that leaves the share of the sun's light that
// reaches a texel, as 4 × 4 places across it have it.
#include "shared/mesh.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, r16f) uniform image3D volume;
layout(binding = 1) uniform sampler2D meshHeights;
layout(push_constant, scalar) uniform Push { MeshVolumePush push; };

/// Half floats end at 65504. Behind a mesh is no light: that depth leaves none after any truncation.
const float DARK = 6.0e4;
const float HIDDEN = 200.0;

bool isHidden(vec3 texel) {
    const vec4 from = vec4(texel, 1.0);
    const vec3 place = vec3(dot(push.toMap[0], from), dot(push.toMap[1], from), dot(push.toMap[2], from));
    const ivec2 at = ivec2(floor(place.xy));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, textureSize(meshHeights, 0)))) return false;
    return place.z < texelFetch(meshHeights, at, 0).r;
}

void main() {
    const uint number = linearInvocation(64u);
    if (number >= uint(push.size.x) * uint(push.size.y) * uint(push.size.z)) return;
    const ivec3 texel = cellNumbered(number, push.size);
    int hidden = 0;
    for (int i = 0; i < 16; ++i) {
        const vec3 off = vec3((vec2(i % 4, i / 4) - 1.5) * 0.25, 0.0);
        if (isHidden(vec3(texel) + off)) ++hidden;
    }
    if (hidden == 0) return;
    const float added = hidden == 16 ? HIDDEN : -log(1.0 - float(hidden) / 16.0);
    const ivec3 at = push.origin + texel;
    imageStore(volume, at, vec4(min(imageLoad(volume, at).r + added, DARK)));
}
