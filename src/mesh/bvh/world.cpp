#include "mesh/bvh/world.h"

#include <array>

namespace lumulus::bvh {
namespace {

using shared::MeshHit, shared::MeshInstance, shared::MeshNode, shared::MeshRay;

/// Appends a tree; its leaves name places from `first` on.
void append(std::vector<MeshNode>& nodes, const Tree& tree, std::size_t first) {
    const auto shift = static_cast<int>(nodes.size()), leaves = static_cast<int>(first);
    for (MeshNode node : tree.nodes) {
        if (node.child0 >= 0) node.child0 += node.count0 > 0 ? leaves : shift;
        if (node.child1 >= 0) node.child1 += node.count1 > 0 ? leaves : shift;
        nodes.push_back(node);
    }
}

Box boxOf(const mesh::Model& model, const glm::dmat4& transform, const glm::dvec3& middle) {
    glm::dvec3 lower(1e300), upper(-1e300);
    for (const mesh::Vertex& vertex : model.vertices) {
        const glm::dvec3 at = glm::dvec3(transform * glm::dvec4(vertex.position, 1.0)) - middle;
        lower = glm::min(lower, at);
        upper = glm::max(upper, at);
    }
    // rounding must not leave a vertex outside
    const glm::dvec3 slack = 1e-6 * (glm::max(glm::abs(lower), glm::abs(upper)) + (upper - lower));
    return {glm::vec3(lower - slack), glm::vec3(upper + slack)};
}

void addModel(World& world, const mesh::Model& model, const Check& check) {
    std::vector<Box> boxes(model.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            boxes[i].add(model.vertices[model.triangles[i].vertices[corner]].position);
    const Tree tree = buildTree(boxes, check);
    world.firstTriangles.push_back(world.triangles.size());
    append(world.nodes, tree, world.triangles.size());
    for (const std::uint32_t number : tree.order) {
        const glm::uvec3 of = model.triangles[number].vertices;
        const glm::vec3 corner = model.vertices[of.x].position;
        world.triangles.push_back(
            {corner, model.vertices[of.y].position - corner, model.vertices[of.z].position - corner});
        world.triangleNumbers.push_back(number);
    }
}

template <class Leaf>
void walk(const World& world, int root, const glm::vec3& origin, const glm::vec3& direction, float least,
          const float& most, const Leaf& leaf) {
    const glm::vec3 inverse = shared::inverseOfRay(direction);
    std::array<int, shared::MESH_DEPTH> stack{};
    std::size_t size = 0;
    int node = root;
    while (node >= 0) {
        const MeshNode& of = world.nodes[static_cast<std::size_t>(node)];
        const float first = shared::meetMeshBox(of.lower0, of.upper0, origin, inverse, least, most);
        const float second = shared::meetMeshBox(of.lower1, of.upper1, origin, inverse, least, most);
        int inner[2] = {-1, -1};
        const bool swapped = second < first;
        for (int i = 0; i < 2; ++i) {
            const bool zero = (i == 0) != swapped;
            if (!((zero ? first : second) < 3e38F)) continue;
            const int child = zero ? of.child0 : of.child1, count = zero ? of.count0 : of.count1;
            if (count > 0)
                leaf(child, count);
            else
                inner[i] = child;
        }
        if (inner[0] >= 0 && inner[1] >= 0) stack[size++] = inner[1];
        node = inner[0] >= 0 ? inner[0] : inner[1];
        if (node < 0 && size > 0) node = stack[--size];
    }
}

}  // namespace

World buildWorld(const mesh::Placed& placed, const Check& check) {
    World world;
    std::vector<Box> boxes;
    glm::dvec3 lower(1e300), upper(-1e300);
    for (const mesh::Instance& instance : placed.instances) {
        const glm::dvec3 at(instance.toWorld[3]);
        lower = glm::min(lower, at);
        upper = glm::max(upper, at);
    }
    world.middle = 0.5 * (lower + upper);
    for (const mesh::Instance& instance : placed.instances) {
        check();
        boxes.push_back(boxOf(placed.models[instance.model], instance.toWorld, world.middle));
        world.box.add(boxes.back());
    }
    const Tree tree = buildTree(boxes, check);
    append(world.nodes, tree, 0);
    std::vector<int> roots;
    for (const mesh::Model& model : placed.models) {
        roots.push_back(static_cast<int>(world.nodes.size()));
        addModel(world, model, check);
    }
    for (const std::uint32_t number : tree.order) {
        const mesh::Instance& instance = placed.instances[number];
        const glm::dmat4 inverse = glm::inverse(instance.toWorld);
        const glm::dvec3 shift(inverse * glm::dvec4(world.middle, 1.0));
        world.instances.push_back({glm::mat3(inverse), glm::vec3(shift), roots[instance.model],
                                   static_cast<int>(world.firstTriangles[instance.model]), static_cast<int>(number)});
    }
    return world;
}

MeshHit nearest(const World& world, const MeshRay& ray) {
    MeshHit hit{ray.most, -1, -1, glm::vec2(0.0F)};
    walk(world, 0, ray.origin, ray.direction, ray.least, hit.distance, [&](int firstInstance, int instances) {
        for (int i = firstInstance; i < firstInstance + instances; ++i) {
            const MeshInstance& instance = world.instances[static_cast<std::size_t>(i)];
            const glm::vec3 origin = instance.toModel * ray.origin + instance.shift,
                            direction = instance.toModel * ray.direction;
            walk(world, instance.root, origin, direction, ray.least, hit.distance, [&](int first, int count) {
                for (int j = first; j < first + count; ++j) {
                    const int number = j - instance.firstTriangle;
                    if (instance.number == ray.fromInstance && number == ray.fromTriangle) continue;
                    const glm::vec3 met = shared::meetTriangle(world.triangles[static_cast<std::size_t>(j)], origin,
                                                               direction, ray.least, hit.distance);
                    if (met.x > 0.0F) hit = {met.x, instance.number, number, {met.y, met.z}};
                }
            });
        }
    });
    return hit;
}

}  // namespace lumulus::bvh
