// Where meshes stand between the sun and the place at which a photon enters clouds.
#ifndef LUMULUS_LIB_MESH_SHADE
#define LUMULUS_LIB_MESH_SHADE

#include "shared/mesh.h"

layout(constant_id = 26) const bool MESHES = false;  // they throw shadows on clouds
layout(binding = 38, scalar) readonly buffer MeshShade { MeshShadeParams meshShade; float meshHeights[]; };

/// Whether a place of the walk [cells] lies in the shadow of a mesh.
bool inMeshShadow(vec3 place) {
    const vec4 from = vec4(place, 1.0);
    const ivec2 at = ivec2(floor(vec2(dot(meshShade.toMap[0], from), dot(meshShade.toMap[1], from))));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, meshShade.size))) return false;
    return dot(meshShade.toMap[2], from) < meshHeights[at.y * meshShade.size.x + at.x];
}

#endif
