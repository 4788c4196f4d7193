// What shapes the tree apart from the samples' densities: uncovered space and optical size.
#include <gtest/gtest.h>

#include "cloud/kdtree.h"
#include "unit/kdtree_samples.h"

namespace lumulus::cloud {
namespace {

using glm::ivec3;

TEST(BlockDensity, IsTheMeanOverTheBlocks) {
    const ivec3 size(21, 9, 14);  // the last blocks are cut
    std::vector<float> density;
    for (int i = 0; i < size.x * size.y * size.z; ++i) density.push_back(static_cast<float>((i * 37) % 101));
    const BlockDensity blocks(density, size, 50.0F);
    for (const shared::LeafBox& box : {shared::LeafBox{{0, 0, 0}, size}, shared::LeafBox{{4, 0, 8}, {8, 4, 12}},
                                       shared::LeafBox{{5, 3, 1}, {6, 5, 2}}, shared::LeafBox{{17, 7, 12}, size}}) {
        double sum = 0.0, count = 0.0;
        for (int z = box.lower.z / 4 * 4; z < std::min((box.upper.z + 3) / 4 * 4, size.z); ++z)
            for (int y = box.lower.y / 4 * 4; y < std::min((box.upper.y + 3) / 4 * 4, size.y); ++y)
                for (int x = box.lower.x / 4 * 4; x < std::min((box.upper.x + 3) / 4 * 4, size.x); ++x) {
                    sum += static_cast<double>(density[static_cast<std::size_t>((z * size.y + y) * size.x + x)]) / 50.0;
                    count += 1.0;
                }
        EXPECT_NEAR(blocks.mean(box), sum / count, 1e-6 * sum / count);
    }
}

/// Samples in one corner: the rest of the box is cut off at their radius of influence.
TEST(KdTreeFinalisation, SplitsOffSpaceThatNoSampleCovers) {
    const ivec3 size(40, 40, 40);
    std::vector<Sample> samples = randomSamples(200, {8, 8, 8}, 1);
    for (Sample& s : samples) {
        s.position += glm::vec3(4.0F, 4.0F, 4.0F);
        s.density = 0.5F;  // no median splits
    }
    const double radius = 2.0;
    KdTreeOptions options;
    options.influenceRadius = glm::dvec3(radius);
    const KdTree tree = buildKdTree(samples, size, options);
    ASSERT_EQ(tree.leaves.size(), 4U);  // one slab an axis beyond 12 + 2; the 2 voxels below are too little
    const shared::LeafBox& core = tree.leaves[static_cast<std::size_t>(tree.find({8, 8, 8}))];
    EXPECT_EQ(core.lower, ivec3(0));
    EXPECT_EQ(core.upper, ivec3(14));
    for (const Sample& s : samples) EXPECT_TRUE(contains(core, s.position));
}

/// No leaf that holds samples keeps an uncovered slab wider than a quarter of its edge (and the snapping).
TEST(KdTreeFinalisation, LeavesNoWideUncoveredSlab) {
    const ivec3 size(64, 32, 48);
    std::vector<Sample> samples = randomSamples(150, size, 3);
    KdTreeOptions options;
    options.densityThreshold = 0.5;
    options.influenceRadius = glm::dvec3(1.5, 1.0, 3.0);
    const KdTree tree = buildKdTree(samples, size, options);
    for (const shared::LeafBox& box : tree.leaves) {
        glm::dvec3 low(1e9), high(-1e9);
        bool any = false;
        for (const Sample& s : samples)
            if (contains(box, s.position)) {
                low = glm::min(low, glm::dvec3(s.position) - options.influenceRadius);
                high = glm::max(high, glm::dvec3(s.position) + options.influenceRadius);
                any = true;
            }
        if (!any) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const double slab = 0.25 * extentOf(box)[axis] + 1.0;
            ASSERT_LE(low[axis] - box.lower[axis], slab);
            ASSERT_LE(box.upper[axis] - high[axis], slab);
        }
    }
}

/// Reduced optical thickness along the longest edge that can be split.
double thickness(const shared::LeafBox& box, const KdTreeOptions& options) {
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        if (extentOf(box)[axis] >= 2) longest = std::max(longest, extentOf(box)[axis] * options.voxelEdge[axis]);
    return longest * options.reducedExtinction * options.density->mean(box);
}

TEST(KdTreeOptical, EveryLeafIsThinAndNoSplitIsNeedless) {
    const ivec3 size(32, 24, 40);
    std::vector<float> density;
    for (int i = 0; i < size.x * size.y * size.z; ++i)
        density.push_back(i % size.x < 16 ? 0.1F : 1.0F);  // thin half, dense half
    const BlockDensity blocks(density, size, 1.0F);
    KdTreeOptions options;
    options.voxelEdge = {1.0, 3.0, 0.5};
    options.influenceRadius = glm::dvec3(100.0);  // no finalisation: what is no median split is an optical one
    options.reducedExtinction = 0.2;
    options.density = &blocks;
    const KdTree tree = buildKdTree(randomSamples(40, size, 1), size, options);
    EXPECT_LT(tree.leaves.size(), static_cast<std::size_t>(options.maxLeaves));
    for (const shared::LeafBox& box : tree.leaves) ASSERT_LE(thickness(box, options), options.opticalLimit);
    const auto boxes = nodeBoxes(tree, size);
    std::size_t optical = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const KdNode& node = tree.nodes[i];
        if (node.median || node.axis < 0) continue;
        ++optical;
        EXPECT_GT(thickness(boxes[i], options), options.opticalLimit);
        EXPECT_EQ(node.plane, (boxes[i].lower[node.axis] + boxes[i].upper[node.axis]) / 2);
    }
    EXPECT_GT(optical, 20U);
}

/// A homogeneous box has gradients only at its rim; its inside must not become one collector.
TEST(KdTreeOptical, SplitsAHomogeneousBox) {
    const ivec3 size(32, 32, 32);
    const std::vector<float> density(32 * 32 * 32, 2.0F);
    const BlockDensity blocks(density, size, 2.0F);
    KdTreeOptions options;
    options.density = &blocks;
    for (const auto& [extinction, leaves] : {std::pair{0.0, 1U}, {0.03, 1U}, {0.0625, 8U}, {0.25, 512U}}) {
        options.reducedExtinction = extinction;
        EXPECT_EQ(buildKdTree({}, size, options).leaves.size(), leaves) << extinction;
    }
}

}  // namespace
}  // namespace lumulus::cloud
