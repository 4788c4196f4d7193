// Shadows of meshes in fog, by a map of how high they reach towards the sun. The includer declares `params`.
#ifndef LUMULUS_LIB_MESH_SHADOW
#define LUMULUS_LIB_MESH_SHADOW

#include "lib/cloud_shadow.glsl"

layout(binding = 36) uniform sampler2D meshHeights;

/// Share of the sun's light that meshes let through to a place: the mean of the four texels around it.
float throughMeshes(vec3 point) {
    if (params.meshes == 0) return 1.0;
    const vec3 place = casterRows(CASTER_TEXELS * params.casters + 4, vec4(point, 1.0)) - vec3(0.5, 0.5, 0.0);
    const ivec2 first = ivec2(floor(place.xy)), size = textureSize(meshHeights, 0);
    if (any(lessThan(first, ivec2(0))) || any(greaterThanEqual(first + 1, size))) return 1.0;
    vec4 open;
    for (int i = 0; i < 4; ++i)
        open[i] = place.z < texelFetch(meshHeights, first + ivec2(i & 1, i >> 1), 0).r ? 0.0 : 1.0;
    const vec2 share = fract(place.xy);
    return mix(mix(open.x, open.y, share.x), mix(open.z, open.w, share.x), share.y);
}

#endif
