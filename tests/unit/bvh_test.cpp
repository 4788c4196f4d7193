// The trees of meshes find what a look at every triangle finds.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh/bvh/world.h"

namespace lumulus::test {
namespace {

using shared::MeshHit, shared::MeshRay;

/// Triangles of very different sizes all over a cube of 2 m, some of them in heaps at one place.
mesh::Model scatteredModel(std::size_t triangles, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-1.0F, 1.0F), share(0.0F, 1.0F);
    mesh::Model model;
    model.materials.emplace_back();
    for (std::size_t i = 0; i < triangles; ++i) {
        const glm::vec3 middle = i % 7 == 0 ? glm::vec3(0.25F) : glm::vec3(place(random), place(random), place(random));
        const float size = 0.5F * std::pow(share(random), 2.0F);
        const auto first = static_cast<std::uint32_t>(model.vertices.size());
        for (int corner = 0; corner < 3; ++corner)
            model.vertices.push_back(
                {middle + size * glm::vec3(place(random), place(random), place(random)), {0.0F, 1.0F, 0.0F}, {}});
        model.triangles.push_back({{first, first + 1, first + 2}, 0});
    }
    return model;
}

mesh::Placed placedModels() {
    mesh::Placed placed;
    placed.models.push_back(scatteredModel(600, 1));
    placed.models.push_back(scatteredModel(3, 2));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-8.0, 8.0), share(0.1, 1.0);
    for (int i = 0; i < 40; ++i) {
        const double turn = place(random), size = share(random);
        glm::dmat4 to(size * std::cos(turn), 0, size * std::sin(turn), 0, 0, size, 0, 0, -size * std::sin(turn), 0,
                      size * std::cos(turn), 0, 0, 0, 0, 1);
        to[3] = glm::dvec4(1000.0 + place(random), place(random), place(random), 1.0);
        placed.instances.push_back({i % 4 == 0 ? 1U : 0U, to});
    }
    return placed;
}

MeshHit bruteForce(const bvh::World& world, const mesh::Placed& placed, const MeshRay& ray) {
    MeshHit hit{ray.most, -1, -1, glm::vec2(0.0F)};
    for (const shared::MeshInstance& instance : world.instances) {
        const std::size_t model = placed.instances[static_cast<std::size_t>(instance.number)].model;
        const glm::vec3 origin = instance.toModel * ray.origin + instance.shift;
        const glm::vec3 direction = instance.toModel * ray.direction;
        for (std::size_t i = 0; i < placed.models[model].triangles.size(); ++i) {
            const glm::vec3 met =
                shared::meetTriangle(world.triangles[static_cast<std::size_t>(instance.firstTriangle) + i], origin,
                                     direction, ray.least, hit.distance);
            if (met.x > 0.0F) hit = {met.x, instance.number, static_cast<int>(i), {met.y, met.z}};
        }
    }
    return hit;
}

TEST(Bvh, AllHitsAreThoseOfEveryTriangle) {
    const mesh::Placed placed = placedModels();
    const bvh::World world = bvh::buildWorld(placed, [] {});
    std::mt19937 random(4);
    std::uniform_real_distribution<float> place(-12.0F, 12.0F), along(-1.0F, 1.0F);
    int met = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::vec3 off = 0.3F * glm::vec3(along(random), along(random), along(random));
        const std::size_t instance = static_cast<std::size_t>(i) % placed.instances.size();
        const glm::vec3 to = glm::vec3(glm::dvec3(placed.instances[instance].toWorld[3]) - world.middle) + off;
        glm::vec3 from(place(random), place(random), place(random));
        if (i % 10 == 0) from = to + glm::vec3(0.0F, i % 20 == 0 ? 9.0F : -9.0F, 0.0F);
        const MeshRay ray{from, 0.0F, glm::normalize(to - from), i % 3 == 0 ? 9.0F : 1e30F, -1, -1};
        const MeshHit expected = bruteForce(world, placed, ray), found = bvh::nearest(world, ray);
        ASSERT_EQ(found.instance, expected.instance) << i;
        if (expected.instance < 0) continue;
        ++met;
        ASSERT_EQ(found.distance, expected.distance) << i;
    }
    EXPECT_GT(met, 50);
}

TEST(Bvh, TheTriangleThatARayLeavesDoesNotCount) {
    mesh::Placed placed;
    placed.models.push_back(scatteredModel(1, 5));
    placed.models[0].vertices = {{{-1, 0, -1}, {0, 1, 0}, {}}, {{1, 0, -1}, {0, 1, 0}, {}}, {{0, 0, 1}, {0, 1, 0}, {}}};
    placed.instances.push_back({0, glm::dmat4(1.0)});
    const bvh::World world = bvh::buildWorld(placed, [] {});
    MeshRay ray{{0, 1, 0}, 0.0F, {0, -1, 0}, 10.0F, -1, -1};
    const MeshHit hit = bvh::nearest(world, ray);
    EXPECT_EQ(hit.instance, 0);
    EXPECT_FLOAT_EQ(hit.distance, 1.0F);
    ray.fromInstance = 0;
    ray.fromTriangle = hit.triangle;
    EXPECT_EQ(bvh::nearest(world, ray).instance, -1);
}

TEST(Bvh, EqualBoxesDoNotMakeItDeep) {
    const std::vector<bvh::Box> boxes(5000, bvh::Box{glm::vec3(0.0F), glm::vec3(1.0F)});
    const bvh::Tree tree = bvh::buildTree(boxes, [] {});
    std::vector<bool> found(boxes.size());
    for (const std::uint32_t box : tree.order) found[box] = true;
    EXPECT_TRUE(std::all_of(found.begin(), found.end(), [](bool is) { return is; }));
    std::vector<int> depth(tree.nodes.size(), 1);
    int deepest = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        deepest = std::max(deepest, depth[i]);
        const shared::MeshNode& node = tree.nodes[i];
        if (node.count0 == 0 && node.child0 >= 0) depth[static_cast<std::size_t>(node.child0)] = depth[i] + 1;
        if (node.count1 == 0 && node.child1 >= 0) depth[static_cast<std::size_t>(node.child1)] = depth[i] + 1;
    }
    EXPECT_LE(deepest, 14);
}

TEST(Bvh, AStopEndsIt) {
    const std::vector<bvh::Box> boxes(100, bvh::Box{glm::vec3(0.0F), glm::vec3(1.0F)});
    EXPECT_THROW(bvh::buildTree(boxes, [] { throw std::runtime_error("stop"); }), std::runtime_error);
}

}  // namespace
}  // namespace lumulus::test
