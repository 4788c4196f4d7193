#version 460
#extension GL_GOOGLE_include_directive : require
// Follows rays through the trees of meshes: that of the instances, and that of the model of each that is met.
#include "shared/mesh.h"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Nodes { MeshNode nodes[]; };
layout(binding = 1, scalar) readonly buffer Triangles { MeshTriangle triangles[]; };
layout(binding = 2, scalar) readonly buffer MeshInstances { MeshInstance instances[]; };
layout(binding = 3, scalar) readonly buffer Rays { MeshRay rays[]; };
layout(binding = 4, scalar) writeonly buffer Hits { MeshHit hits[]; };
layout(push_constant, scalar) uniform Push { MeshPush push; };

/// Children of a node that a ray meets, nearer first; −1 for none.
struct Children {
    ivec2 child;
    ivec2 count;
};

Children childrenOf(int number, vec3 origin, vec3 inverse, float least, float most) {
    const MeshNode node = nodes[number];
    const float first = meetMeshBox(node.lower0, node.upper0, origin, inverse, least, most);
    const float second = meetMeshBox(node.lower1, node.upper1, origin, inverse, least, most);
    Children found = Children(ivec2(first < 3.0e38 ? node.child0 : -1, second < 3.0e38 ? node.child1 : -1),
                              ivec2(node.count0, node.count1));
    return second < first ? Children(found.child.yx, found.count.yx) : found;
}

void meetLeaf(MeshInstance instance, MeshRay ray, vec3 origin, vec3 direction, int first, int count, inout MeshHit hit) {
    for (int i = first; i < first + count; ++i) {
        if (instance.number == ray.fromInstance && i - instance.firstTriangle == ray.fromTriangle) continue;
        const vec3 met = meetTriangle(triangles[i], origin, direction, ray.least, hit.distance);
        if (met.x > 0.0) hit = MeshHit(met.x, instance.number, i - instance.firstTriangle, met.yz);
    }
}

void meetInstance(MeshInstance instance, MeshRay ray, inout MeshHit hit) {
    const vec3 origin = instance.toModel * ray.origin + instance.shift, direction = instance.toModel * ray.direction;
    const vec3 inverse = inverseOfRay(direction);
    int stack[MESH_DEPTH];
    int size = 0, node = instance.root;
    while (node >= 0) {
        const Children found = childrenOf(node, origin, inverse, ray.least, hit.distance);
        ivec2 inner = ivec2(-1);
        for (int i = 0; i < 2; ++i) {
            if (found.child[i] < 0) continue;
            if (found.count[i] > 0)
                meetLeaf(instance, ray, origin, direction, found.child[i], found.count[i], hit);
            else
                inner[i] = found.child[i];
        }
        if (inner.x >= 0 && inner.y >= 0) stack[size++] = inner.y;
        node = inner.x >= 0 ? inner.x : inner.y;
        if (node < 0 && size > 0) node = stack[--size];
        if (push.anyHit != 0 && hit.instance >= 0) node = -1;
    }
}

MeshHit follow(MeshRay ray) {
    MeshHit hit = MeshHit(ray.most, -1, -1, vec2(0.0));
    const vec3 inverse = inverseOfRay(ray.direction);
    int stack[MESH_DEPTH];
    int size = 0, node = 0;
    while (node >= 0) {
        const Children found = childrenOf(node, ray.origin, inverse, ray.least, hit.distance);
        ivec2 inner = ivec2(-1);
        for (int i = 0; i < 2; ++i) {
            if (found.child[i] < 0) continue;
            if (found.count[i] == 0) inner[i] = found.child[i];
            for (int j = 0; j < found.count[i]; ++j) meetInstance(instances[found.child[i] + j], ray, hit);
        }
        if (inner.x >= 0 && inner.y >= 0) stack[size++] = inner.y;
        node = inner.x >= 0 ? inner.x : inner.y;
        if (node < 0 && size > 0) node = stack[--size];
        if (push.anyHit != 0 && hit.instance >= 0) node = -1;
    }
    return hit;
}

void main() {
    const uint index = linearInvocation(64u);
    if (index >= push.rays) return;
    const MeshRay ray = rays[index];
    MeshHit hit = MeshHit(0.0, -1, -1, vec2(0.0));
    if (ray.most > ray.least) hit = follow(ray);
    hits[index] = hit;
}
