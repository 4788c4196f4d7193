// Levels of detail: when which one is taken, and that a coarse field has the mass of the fine one.
#include "cloud/level_of_detail.h"

#include <gtest/gtest.h>

#include <numeric>

#include "stat/ball.h"

namespace lumulus::cloud {
namespace {

TEST(LevelOfDetail, VoxelsAreNoLargerThanAPixel) {
    EXPECT_EQ(levelOfDetail(192, 3.0), 0);
    EXPECT_EQ(levelOfDetail(192, 0.51), 0);
    EXPECT_EQ(levelOfDetail(192, 0.5), 1);
    EXPECT_EQ(levelOfDetail(192, 0.25), 2);
    EXPECT_EQ(levelOfDetail(192, 1e-9), 5) << "four voxels stay";
    EXPECT_EQ(levelOfDetail(100000, 1e-9), coarsestLevel);
    EXPECT_EQ(levelOfDetail(7, 1e-9), 0);
}

TEST(LevelOfDetail, LightCrossesAVoxel) {
    EXPECT_EQ(levelOfThickness(2.5), 0);
    EXPECT_EQ(levelOfThickness(1.1), 0);
    EXPECT_EQ(levelOfThickness(0.9), 1);
    EXPECT_EQ(levelOfThickness(0.24), 3);
    EXPECT_EQ(levelOfThickness(0.0), coarsestLevel);
}

TEST(LevelOfDetail, CollectorsFollowTheSizeInThePicture) {
    EXPECT_EQ(collectorsFor(0.0), 30);
    EXPECT_EQ(collectorsFor(48.0), 951);
    EXPECT_EQ(collectorsFor(1e9), 1000000000);
}

TEST(LevelOfDetail, CoarseFieldsKeepTheMass) {
    const vdb::Volume fine = ballVolume(21, 10.0);
    const double mass = std::accumulate(fine.density.begin(), fine.density.end(), 0.0);
    for (const int level : {1, 2, 3}) {
        const vdb::Volume coarse = coarsened(fine, level);
        EXPECT_EQ(coarse.size, (fine.size + (1 << level) - 1) / (1 << level));
        const double sum = std::accumulate(coarse.density.begin(), coarse.density.end(), 0.0);
        EXPECT_NEAR(sum * (1 << (3 * level)), mass, 1e-5 * mass);
        EXPECT_LE(coarse.maximum, fine.maximum);
        EXPECT_EQ(coarse.toWorld.point(glm::dvec3(1.0)), fine.toWorld.point(glm::dvec3(1 << level)));
    }
}

}  // namespace
}  // namespace lumulus::cloud
