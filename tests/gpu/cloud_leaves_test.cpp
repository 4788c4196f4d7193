#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "cloud/asset.h"
#include "gpu/transfer.h"
#include "support/cloud_cases.h"
#include "support/field.h"
#include "support/vulkan_fixture.h"

namespace lumulus::cloud {
namespace {

using glm::ivec3;
using CloudLeaves = test::VulkanTest;

/// Collector of each voxel, −1 for none.
std::vector<std::int64_t> downloadIndex(gpu::Context& context, const Asset& cloud) {
    std::vector<std::int64_t> index;
    if (cloud.collectorIndex.format() == VK_FORMAT_R16_UINT) {
        for (const std::uint16_t i : gpu::download<std::uint16_t>(context, cloud.collectorIndex))
            index.push_back(i == 0xFFFFU ? -1 : i);
    } else {
        for (const std::uint32_t i : gpu::download<std::uint32_t>(context, cloud.collectorIndex))
            index.push_back(i == 0xFFFFFFFFU ? -1 : static_cast<std::int64_t>(i));
    }
    return index;
}

/// Every voxel names the collector of the leaf that a walk of the tree finds; no collector: no mass.
void expectIndexOfTree(gpu::Context& context, const Asset& cloud, const test::Field& field) {
    const std::vector<std::int64_t> index = downloadIndex(context, cloud);
    const auto collectors = static_cast<std::int64_t>(cloud.collectors.size());
    for (int z = 0; z < cloud.size.z; ++z)
        for (int y = 0; y < cloud.size.y; ++y)
            for (int x = 0; x < cloud.size.x; ++x) {
                const ivec3 voxel(x, y, z);
                const auto place = static_cast<std::size_t>((z * cloud.size.y + y) * cloud.size.x + x);
                const shared::LeafBox& leaf = cloud.tree.leaves[static_cast<std::size_t>(cloud.tree.find(voxel))];
                if (index[place] < 0) {
                    ASSERT_EQ(field.voxelMass(voxel), 0.0) << "mass without a collector";
                    continue;
                }
                ASSERT_LT(index[place], collectors);
                const shared::LeafBox& box = cloud.collectors[static_cast<std::size_t>(index[place])].box;
                ASSERT_EQ(box.lower, leaf.lower);
                ASSERT_EQ(box.upper, leaf.upper);
            }
}

TEST_F(CloudLeaves, IndexAgreesWithTheTree) {
    for (const test::CloudCase& c : test::cloudCases()) {
        SCOPED_TRACE(c.name);
        const test::Field field(c.volume);
        ASSERT_EQ(field.format(), c.format);
        const Asset cloud = prepare(context, c.volume, test::prepareOptions(2000));
        EXPECT_EQ(cloud.format, c.format);
        EXPECT_GT(cloud.collectors.size(), 20U);
        expectIndexOfTree(context, cloud, field);
    }
}

/// More collectors than 16 bits can number.
TEST_F(CloudLeaves, IndexOfManyCollectorsIsWide) {
    const vdb::Volume volume = boxVolume({48, 40, 36});
    PrepareOptions options = test::prepareOptions(100);
    options.preparation.maxLeaves = 90000;
    options.reducedExtinction = 100.0;  // every voxel is a leaf
    const Asset cloud = prepare(context, volume, options);
    ASSERT_GT(cloud.collectors.size(), 65536U);
    EXPECT_EQ(cloud.collectorIndex.format(), VK_FORMAT_R32_UINT);
    expectIndexOfTree(context, cloud, test::Field(volume));
}

TEST_F(CloudLeaves, MassesAreTheIntegralsOfTheInterpolatedField) {
    for (const test::CloudCase& c : test::cloudCases()) {
        SCOPED_TRACE(c.name);
        const test::Field field(c.volume);
        const Asset cloud = prepare(context, c.volume, test::prepareOptions(2000));
        double total = 0.0;
        for (const Collector& collector : cloud.collectors) {
            const double mass = field.mass(collector.box.lower, collector.box.upper);
            ASSERT_NEAR(static_cast<double>(collector.mass), mass, 1e-4 * mass);
            total += static_cast<double>(collector.mass);
        }
        // The ring of zeros holds the field in, so that each voxel gives its whole value to the integral.
        EXPECT_NEAR(total, field.sumOfTexels(), 1e-5 * field.sumOfTexels());
    }
}

TEST_F(CloudLeaves, CentresAndOccupancyDescribeTheLeaf) {
    for (const test::CloudCase& c : test::cloudCases()) {
        SCOPED_TRACE(c.name);
        const test::Field field(c.volume);
        const Asset cloud = prepare(context, c.volume, test::prepareOptions(2000));
        for (const Collector& collector : cloud.collectors) {
            const ivec3 lower = collector.box.lower, upper = collector.box.upper;
            glm::dvec3 moment(0.0);
            double sum = 0.0, voxels = 0.0, occupied = 0.0;
            for (int z = lower.z; z < upper.z; ++z)
                for (int y = lower.y; y < upper.y; ++y)
                    for (int x = lower.x; x < upper.x; ++x) {
                        // 2³ midpoints a voxel: the centre is a place to draw at, and needs no more
                        for (int i = 0; i < 8; ++i) {
                            const glm::dvec3 point =
                                glm::dvec3(x, y, z) + 0.25 + 0.5 * glm::dvec3(i & 1, (i >> 1) & 1, i >> 2);
                            moment += field.at(point) * point;
                            sum += field.at(point);
                        }
                        voxels += 1.0;
                        occupied += field.texel({x, y, z}) > 0.0 ? 1.0 : 0.0;
                    }
            ASSERT_LT(glm::distance(glm::dvec3(collector.centre), moment / sum), 1e-3);
            ASSERT_NEAR(static_cast<double>(collector.occupied), occupied / voxels, 1e-5);
        }
    }
}

TEST_F(CloudLeaves, PreparationIsTheSameTwice) {
    const vdb::Volume volume = test::cloudCases()[1].volume;
    const Asset first = prepare(context, volume, test::prepareOptions(3000));
    const Asset second = prepare(context, volume, test::prepareOptions(3000));
    ASSERT_EQ(first.samples.size(), second.samples.size());
    for (std::size_t i = 0; i < first.samples.size(); ++i)
        ASSERT_TRUE(first.samples[i].position == second.samples[i].position &&
                    first.samples[i].density == second.samples[i].density);
    ASSERT_EQ(first.collectors.size(), second.collectors.size());
    for (std::size_t i = 0; i < first.collectors.size(); ++i) {
        const Collector &a = first.collectors[i], &b = second.collectors[i];
        ASSERT_TRUE(a.centre == b.centre && a.mass == b.mass && a.majorant == b.majorant && a.box.lower == b.box.lower);
    }
}

}  // namespace
}  // namespace lumulus::cloud
