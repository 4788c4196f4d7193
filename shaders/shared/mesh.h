// Interface structs of triangle meshes, and how a ray meets their boxes and triangles: the same arithmetic on host and
// GPU. Positions of a model are its own [m], those of the world relative to a point that is the middle of all meshes.
#ifndef LUMULUS_SHARED_MESH_H
#define LUMULUS_SHARED_MESH_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Nodes deep that a tree is at most, and so what a walk must remember.
const int MESH_DEPTH = 64;

/// A node with the boxes of both children. A child with a count is a leaf: so many triangles or instances from `child`
/// on. Without, it is the node `child`. A child that does not exist has an empty box.
struct MeshNode {
    vec3 lower0;
    vec3 upper0;
    vec3 lower1;
    vec3 upper1;
    int child0;
    int child1;
    int count0;
    int count1;
};

/// A corner and the edges from it to the others.
struct MeshTriangle {
    vec3 corner;
    vec3 edge1;
    vec3 edge2;
};

/// A model in the world, in the order of the leaves.
struct MeshInstance {
    mat3 toModel;
    vec3 shift;         // to the model's positions: toModel · place + shift
    int root;           // node of the model
    int firstTriangle;  // of the model, among those of all
    int number;         // in the order of the scene
};

/// Distances count in lengths of `direction`.
struct MeshRay {
    vec3 origin;
    float least;  // only what is farther counts
    vec3 direction;
    float most;        // and what is nearer; below 0: the ray is not followed
    int fromInstance;  // the triangle that it leaves does not count; −1: none
    int fromTriangle;
};

/// What a ray meets first. `instance` −1: nothing.
struct MeshHit {
    float distance;
    int instance;  // in the order of the scene
    int triangle;  // in the order of the leaves, from the model's first
    vec2 place;    // shares of the second and third corner
};

/// Rays along each side of a pixel that shows the edge of a mesh.
const int MESH_EDGE_RAYS = 4;

/// What a pixel shows of meshes.
struct MeshPixel {
    vec3 radiance;   // mean over its rays that meet one [W/(m² sr)]
    float distance;  // of all of its rays [m]; FAR_DEPTH: none meets one
    int edge;        // or −1; else the rays differ, and their distances are those of this number
};

struct MeshPush {
    uint rays;
    int anyHit;  // 1: whatever is met, for shadows
};

/// Adds shadows of meshes to a shadow volume of a cloud.
struct MeshVolumePush {
    vec4 toMap[3];  // rows from texels of the volume to columns and rows of the map of heights, and height [m]
    ivec3 origin;   // of the volume in its image
    ivec3 size;
};

/// The map of heights as photons of the sun ask it; behind it lie the heights, columns fastest.
struct MeshShadeParams {
    vec4 toMap[3];  // rows from cells of the walk to columns and rows of the map, and height [m]
    ivec2 size;     // of the map
};

/// Distance at which a ray enters a box, given 1 / direction; beyond `most` where it does not within (least, most).
SHARED_FN float meetMeshBox(vec3 lower, vec3 upper, vec3 origin, vec3 inverse, float least, float most) {
    const vec3 a = (lower - origin) * inverse, b = (upper - origin) * inverse;
    const vec3 near = min(a, b), far = max(a, b);
    const float enter = max(max(near.x, near.y), max(near.z, least));
    // a rounding of both sides must not lose a triangle that lies in the box's face
    const float leave = min(min(far.x, far.y), min(far.z, most)) * 1.0000004F;
    return enter <= leave ? enter : 3.4e38F;
}

/// 1 / direction without an infinity, whose product with 0 is no number.
SHARED_FN vec3 inverseOfRay(vec3 direction) {
    vec3 safe = direction;
    if (abs(safe.x) < 1.0e-20F) safe.x = 1.0e-20F;
    if (abs(safe.y) < 1.0e-20F) safe.y = 1.0e-20F;
    if (abs(safe.z) < 1.0e-20F) safe.z = 1.0e-20F;
    return 1.0F / safe;
}

/// Where a ray meets a triangle (Möller and Trumbore 1997): distance and shares of the second and third corner; a
/// negative distance where it does not within (least, most).
SHARED_FN vec3 meetTriangle(MeshTriangle triangle, vec3 origin, vec3 direction, float least, float most) {
    const vec3 across = cross(direction, triangle.edge2);
    const float volume = dot(triangle.edge1, across);
    if (volume == 0.0F) return vec3(-1.0F);
    const float inverse = 1.0F / volume;
    const vec3 from = origin - triangle.corner;
    const float u = dot(from, across) * inverse;
    const vec3 other = cross(from, triangle.edge1);
    const float v = dot(direction, other) * inverse;
    const float distance = dot(triangle.edge2, other) * inverse;
    const bool inside = u >= 0.0F && v >= 0.0F && u + v <= 1.0F;
    return inside && distance > least && distance < most ? vec3(distance, u, v) : vec3(-1.0F);
}

#ifdef __cplusplus
static_assert(sizeof(MeshNode) == 64 && offsetof(MeshNode, child0) == 48);
static_assert(sizeof(MeshTriangle) == 36 && offsetof(MeshTriangle, edge2) == 24);
static_assert(sizeof(MeshInstance) == 60 && offsetof(MeshInstance, root) == 48);
static_assert(sizeof(MeshRay) == 40 && offsetof(MeshRay, fromInstance) == 32);
static_assert(sizeof(MeshHit) == 20 && offsetof(MeshHit, place) == 12);
static_assert(sizeof(MeshPixel) == 20 && offsetof(MeshPixel, edge) == 16);
static_assert(sizeof(MeshVolumePush) == 72 && offsetof(MeshVolumePush, size) == 60);
static_assert(sizeof(MeshShadeParams) == 56 && offsetof(MeshShadeParams, size) == 48);
static_assert(sizeof(MeshPush) == 8 && offsetof(MeshPush, anyHit) == 4);
#endif

SHARED_END

#endif
