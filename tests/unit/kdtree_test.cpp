#include "cloud/kdtree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "unit/kdtree_samples.h"

namespace lumulus::cloud {
namespace {

using glm::ivec3;

/// Every voxel lies in one leaf, which is the one that the walk finds.
void expectTiling(const KdTree& tree, const ivec3& size) {
    const auto index = [&](const ivec3& v) { return static_cast<std::size_t>((v.z * size.y + v.y) * size.x + v.x); };
    std::vector<int> owner(static_cast<std::size_t>(size.x * size.y * size.z), -1);
    for (std::size_t leaf = 0; leaf < tree.leaves.size(); ++leaf) {
        const shared::LeafBox& box = tree.leaves[leaf];
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_GE(box.lower[axis], 0);
            ASSERT_LT(box.lower[axis], box.upper[axis]);
            ASSERT_LE(box.upper[axis], size[axis]);
        }
        for (int z = box.lower.z; z < box.upper.z; ++z)
            for (int y = box.lower.y; y < box.upper.y; ++y)
                for (int x = box.lower.x; x < box.upper.x; ++x) {
                    int& known = owner[index({x, y, z})];
                    ASSERT_EQ(known, -1) << "leaves " << known << " and " << leaf << " overlap";
                    known = static_cast<int>(leaf);
                }
    }
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                ASSERT_NE(owner[index({x, y, z})], -1) << "a gap";
                ASSERT_EQ(tree.find({x, y, z}), owner[index({x, y, z})]);
            }
}

std::vector<Sample> onTheBoundary(const ivec3& size) {
    std::vector<Sample> samples = randomSamples(400, size, 7);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const int axis = static_cast<int>(i % 3);
        samples[i].position[axis] = i % 2 == 0 ? 0.0F : static_cast<float>(size[axis]);
    }
    return samples;
}

TEST(KdTree, LeavesTileTheBox) {
    for (const ivec3& size : {ivec3(1), ivec3(2, 1, 1), ivec3(3, 3, 3), ivec3(40, 17, 23), ivec3(1, 64, 5)}) {
        const glm::vec3 middle = 0.5F * glm::vec3(size);
        const std::vector<std::vector<Sample>> sets = {
            {},
            {{middle, 0.5F}},
            std::vector<Sample>(300, {middle, 0.5F}),
            randomSamples(50, size, 1),
            randomSamples(3000, size, 2),
            onTheBoundary(size),
        };
        for (const auto& samples : sets)
            for (const double threshold : {0.0, 0.1, 1.0}) {
                SCOPED_TRACE(testing::Message() << size.x << " " << size.y << " " << size.z << ", " << samples.size()
                                                << " samples, threshold " << threshold);
                KdTreeOptions options;
                options.densityThreshold = threshold;
                expectTiling(buildKdTree(samples, size, options), size);
            }
    }
}

/// One place with every density: nothing can separate the samples, and the splitting ends all the same.
TEST(KdTree, EqualPlacesOfDifferentDensityEnd) {
    std::vector<Sample> samples;
    for (int i = 0; i < 500; ++i) samples.push_back({glm::vec3(3.25F, 8.5F, 2.0F), static_cast<float>(i) / 500.0F});
    const ivec3 size(12, 12, 12);
    const KdTree tree = buildKdTree(samples, size, {});
    expectTiling(tree, size);
    EXPECT_LT(tree.leaves.size(), 64U);
}

TEST(KdTree, WithoutSamplesThereIsOneLeaf) {
    const KdTree tree = buildKdTree({}, {9, 8, 7}, {});
    ASSERT_EQ(tree.leaves.size(), 1U);
    EXPECT_EQ(tree.leaves[0].upper, ivec3(9, 8, 7));
    EXPECT_EQ(tree.nodes.size(), 1U);
}

/// Snapping to voxel boundaries moves the plane from the median by at most one voxel, half of it by rounding.
TEST(KdTree, PlanesAreMediansToAVoxel) {
    const ivec3 size(60, 40, 50);
    for (const unsigned seed : {1U, 2U, 3U}) {
        std::vector<Sample> samples = randomSamples(4000, size, seed);
        for (Sample& s : samples) s.position.x = s.position.x * s.position.x / 60.0F;  // uneven
        const KdTree tree = buildKdTree(samples, size, {});
        const auto boxes = nodeBoxes(tree, size);
        int seen = 0;
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const KdNode& node = tree.nodes[i];
            if (!node.median) continue;
            std::vector<float> places;
            for (const Sample& s : samples)
                if (contains(boxes[i], s.position)) places.push_back(s.position[node.axis]);
            ASSERT_GE(places.size(), 2U);
            std::sort(places.begin(), places.end());
            const float below = places[(places.size() - 1) / 2], above = places[places.size() / 2];
            ASSERT_GE(static_cast<float>(node.plane), below - 1.0F);
            ASSERT_LE(static_cast<float>(node.plane), above + 1.0F);
            ++seen;
        }
        EXPECT_GT(seen, 300);
    }
}

/// The axis is the one that leaves the least variance of density in the halves: here only y tells densities apart.
TEST(KdTree, SplitsWhereDensityChanges) {
    const ivec3 size(32, 32, 32);
    std::vector<Sample> samples = randomSamples(2000, size, 5);
    for (Sample& s : samples) s.density = s.position.y < 16.0F ? 0.1F : 0.9F;
    KdTreeOptions options;
    options.influenceRadius = glm::dvec3(40.0);
    const KdTree tree = buildKdTree(samples, size, options);
    ASSERT_EQ(tree.nodes[0].axis, 1);
    EXPECT_NEAR(tree.nodes[0].plane, 16, 1);
}

TEST(KdTree, NeverHasMoreLeavesThanAsked) {
    const ivec3 size(48, 48, 48);
    const std::vector<float> density(48 * 48 * 48, 1.0F);
    const BlockDensity blocks(density, size, 1.0F);
    const auto samples = randomSamples(3000, size, 3);
    for (const int most : {1, 2, 7, 100, 1000})
        for (const double reducedExtinction : {0.0, 1.0}) {
            KdTreeOptions options;
            options.maxLeaves = most;
            options.reducedExtinction = reducedExtinction;
            options.density = &blocks;
            const KdTree tree = buildKdTree(samples, size, options);
            EXPECT_EQ(tree.leaves.size(), static_cast<std::size_t>(most));
            EXPECT_TRUE(tree.limited);
            expectTiling(tree, size);
        }
}

TEST(KdTree, IsNotLimitedByRoomForItsLeaves) {
    const ivec3 size(48, 48, 48);
    const auto samples = randomSamples(3000, size, 3);
    KdTreeOptions options;
    const std::size_t leaves = buildKdTree(samples, size, options).leaves.size();
    options.maxLeaves = static_cast<int>(leaves);
    EXPECT_FALSE(buildKdTree(samples, size, options).limited);
    options.maxLeaves = static_cast<int>(leaves) / 2;
    EXPECT_TRUE(buildKdTree(samples, size, options).limited);
}

/// The smooth field that the next test samples.
float ramp(const glm::vec3& p) {
    return 0.5F + 0.5F * std::sin(0.15F * p.x) * std::cos(0.11F * p.y + 0.05F * p.z);
}

/// Mean over the voxels of the range of density in the voxel's leaf.
double meanRange(const KdTree& tree, const ivec3& size) {
    double sum = 0.0;
    for (const shared::LeafBox& box : tree.leaves) {
        float low = 1.0F, high = 0.0F;
        for (int z = box.lower.z; z < box.upper.z; ++z)
            for (int y = box.lower.y; y < box.upper.y; ++y)
                for (int x = box.lower.x; x < box.upper.x; ++x) {
                    const float value = ramp(glm::vec3(x, y, z) + 0.5F);
                    low = std::min(low, value);
                    high = std::max(high, value);
                }
        const ivec3 e = extentOf(box);
        sum += static_cast<double>(high - low) * e.x * e.y * e.z;
    }
    return sum / (static_cast<double>(size.x) * size.y * size.z);
}

TEST(KdTree, MoreSamplesFindMoreOfTheDensity) {
    const ivec3 size(48, 48, 48);
    double before = 1.0;
    for (const std::size_t count : {std::size_t{100}, std::size_t{1000}, std::size_t{10000}}) {
        std::vector<Sample> samples = randomSamples(count, size, 11);
        for (Sample& s : samples) s.density = ramp(s.position);
        KdTreeOptions options;
        options.densityThreshold = 0.01;
        options.influenceRadius = glm::dvec3(30.0);
        const double range = meanRange(buildKdTree(samples, size, options), size);
        EXPECT_LT(range, 0.75 * before) << count << " samples";
        before = range;
    }
    EXPECT_LT(before, 0.12);
}

/// Where no limit stops it, a leaf that is left whole has no more range than the threshold, or is one voxel wide.
TEST(KdTree, LeavesAreWithinTheThreshold) {
    const ivec3 size(24, 20, 28);
    const auto samples = randomSamples(5000, size, 9);
    KdTreeOptions options;
    options.densityThreshold = 0.3;
    const KdTree tree = buildKdTree(samples, size, options);
    for (const shared::LeafBox& box : tree.leaves) {
        if (extentOf(box) == ivec3(1)) continue;
        float low = 1.0F, high = 0.0F;
        for (const Sample& s : samples)
            if (contains(box, s.position)) {
                low = std::min(low, s.density);
                high = std::max(high, s.density);
            }
        ASSERT_LT(high - low, 0.3F);
    }
}

TEST(KdTree, DoesNotDependOnThreads) {
    const ivec3 size(64, 64, 64);
    std::vector<float> density(64 * 64 * 64);
    for (std::size_t i = 0; i < density.size(); ++i) density[i] = static_cast<float>(i % 97) / 97.0F;
    const auto build = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const BlockDensity blocks(density, size, 1.0F);
        KdTreeOptions options;
        options.reducedExtinction = 0.3;
        options.density = &blocks;
        return buildKdTree(randomSamples(8000, size, 4), size, options);
    };
    const KdTree one = build(1), two = build(2);
    ASSERT_EQ(one.nodes.size(), two.nodes.size());
    ASSERT_EQ(one.leaves.size(), two.leaves.size());
    for (std::size_t i = 0; i < one.nodes.size(); ++i) {
        const KdNode &a = one.nodes[i], &b = two.nodes[i];
        ASSERT_TRUE(a.axis == b.axis && a.plane == b.plane && a.child[0] == b.child[0] && a.child[1] == b.child[1] &&
                    a.leaf == b.leaf && a.median == b.median);
    }
}

}  // namespace
}  // namespace lumulus::cloud
