// What the loader makes of values that tools leave behind, and of specks far away.
#include <gmock/gmock.h>

#include <limits>

#include "unit/vdb_grids.h"

namespace lumulus::test {
namespace {

using Values = GridFiles;
using openvdb::Coord;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// 10³ voxels of density 2.
openvdb::FloatGrid::Ptr makeCube(float background = 0.0F) {
    const auto grid = makeGrid(background);
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 1000; ++i) accessor.setValue(Coord(i % 10, i / 10 % 10, i / 100), 2.0F);
    return grid;
}

TEST_F(Values, InactiveVoxelsTakeNoPart) {
    const auto grid = makeCube();
    auto accessor = grid->getAccessor();
    accessor.setValueOff({3, 3, 3}, -1.0F);
    accessor.setValueOff({4, 4, 4}, nan);
    accessor.setValueOff({5, 5, 5}, 7.0F);
    accessor.setValueOff({12, 5, 5}, infinity);
    grid->tree().addTile(1, Coord(64, 64, 64), 3.0F, false);
    const auto loaded = loadGrid(grid);
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_EQ(loaded.volume.size, glm::ivec3(12));
    EXPECT_EQ(loaded.volume.maximum, 2.0F);
    EXPECT_DOUBLE_EQ(mass(loaded.volume), 2.0 * 997);
}

TEST_F(Values, TheBackgroundTakesNoPart) {
    for (const float background : {0.25F, -1.0F, nan, infinity}) {
        const auto grid = makeCube(background);
        grid->tree().setValue({20, 0, 0}, 1.0F);
        const auto loaded = loadGrid(grid);
        EXPECT_EQ(loaded.warnings.size(), background > 0.0F ? 1U : 0U) << background;
        EXPECT_DOUBLE_EQ(mass(loaded.volume), 2001.0) << background;
        EXPECT_TRUE(hasRing(loaded.volume));
    }
    EXPECT_THAT(loadGrid(makeCube(0.25F)).warnings, ElementsAre(HasSubstr("background 0.25")));
}

TEST_F(Values, SmallNegativesBecomeZero) {
    const auto grid = makeCube();
    auto accessor = grid->getAccessor();
    accessor.setValue({3, 3, 3}, -1e-7F);
    accessor.setValue({30, 3, 3}, -0.02F);  // 1 % of the maximum, and outside of the rest
    accessor.setValue({4, 3, 3}, -0.0F);
    const auto loaded = loadGrid(grid);
    EXPECT_THAT(loaded.warnings, ElementsAre(AllOf(HasSubstr("2 negative voxels"), HasSubstr("-0.02"))));
    EXPECT_EQ(loaded.volume.size, glm::ivec3(12));
    EXPECT_DOUBLE_EQ(mass(loaded.volume), 2.0 * 998);
}

TEST_F(Values, LargeNegativesAreErrorsWithAMend) {
    const auto grid = makeCube();
    grid->tree().setValue({3, 3, 3}, -1e-7F);
    grid->tree().setValue({3, 4, 3}, -0.021F);
    vdb::LoadOptions options;
    options.keys = "cloud.7";
    EXPECT_THAT(refusal(save({grid}), options),
                AllOf(HasSubstr("value -0.021 at voxel (3, 4, 3)"), HasSubstr("cloud.7.clamp = true")));
    grid->tree().addTile(1, Coord(64, 64, 64), -1.0F, true);
    EXPECT_THAT(refusal(save({grid}), options), HasSubstr("value -1 at voxel (64, 64, 64)"));
}

TEST_F(Values, ClampMakesThemZero) {
    const auto grid = makeCube();
    auto accessor = grid->getAccessor();
    accessor.setValue({0, 0, 0}, nan);
    accessor.setValue({1, 0, 0}, infinity);
    accessor.setValue({2, 0, 0}, -infinity);
    accessor.setValue({3, 0, 0}, -5.0F);
    grid->tree().addTile(1, Coord(64, 64, 64), nan, true);
    EXPECT_THAT(refusal(save({grid})), AllOf(HasSubstr("nan"), HasSubstr("(0, 0, 0)"), HasSubstr("cloud.0.clamp")));
    vdb::LoadOptions options;
    options.clamp = true;
    const auto loaded = loadGrid(grid, options);
    EXPECT_THAT(loaded.warnings, ElementsAre(AllOf(HasSubstr("1 negative voxel,"), HasSubstr("-5")),
                                             HasSubstr("515 voxels that are infinite or not a number")));
    EXPECT_EQ(loaded.volume.size, glm::ivec3(12));
    EXPECT_DOUBLE_EQ(mass(loaded.volume), 2.0 * 996);
    EXPECT_EQ(loaded.volume.maximum, 2.0F);
}

TEST_F(Values, NothingButNegativesIsAnError) {
    const auto grid = makeGrid();
    grid->tree().setValue({1, 1, 1}, -1e-7F);
    EXPECT_THAT(refusal(save({grid})), HasSubstr("value -1e-07"));
    vdb::LoadOptions options;
    options.clamp = true;
    EXPECT_TRUE(loadGrid(grid, options).volume.empty());
}

TEST_F(Values, DistancesTaggedAsFog) {
    const auto grid = makeGrid(3.0F);
    grid->tree().setValue({0, 0, 0}, 2.0F);
    grid->tree().setValue({1, 0, 0}, -2.0F);
    EXPECT_THAT(refusal(save({grid})), HasSubstr("level set"));
}

TEST_F(Values, SpecksFarAwayAreLeftOut) {
    const auto grid = makeCube();  // mass 2000
    auto accessor = grid->getAccessor();
    accessor.setValue({30000, 20000, 10000}, 1e-6F);
    accessor.setValue({-30000, 5, 5}, 5e-4F);
    accessor.setValue({5, 5, 77}, 5e-4F);
    const auto loaded = loadGrid(grid);
    EXPECT_EQ(loaded.volume.size, glm::ivec3(12));
    EXPECT_DOUBLE_EQ(mass(loaded.volume), 2000.0);
    EXPECT_EQ(loaded.volume.toWorld.point({1.5, 1.5, 1.5}), glm::dvec3(0.0));
    EXPECT_THAT(loaded.warnings,
                ElementsAre(AllOf(HasSubstr("3 voxels with 5e-07 of its mass"), HasSubstr("left out"))));
}

TEST_F(Values, WhatWeighsMoreIsKept) {
    const auto grid = makeCube();
    grid->tree().setValue({0, 0, 1000}, 0.0021F);  // more than a millionth of the mass
    EXPECT_EQ(loadGrid(grid).volume.size, glm::ivec3(12, 12, 1003));
    // half of a cloud is no speck, whatever its density
    const auto two = makeCube();
    two->tree().setValue({0, 0, 1000}, 2000.0F);
    EXPECT_EQ(loadGrid(two).volume.size.z, 1003);
}

TEST_F(Values, ThinEdgesAreKept) {
    const auto near = makeCube();
    near->tree().setValue({0, 0, 17}, 1e-6F);  // a gap of 7 voxels is none
    EXPECT_EQ(loadGrid(near).volume.size.z, 20);
    // behind a gap, but the box is not much smaller without it
    const auto wide = makeGrid();
    wide->fill(openvdb::CoordBBox(Coord(0), Coord(39, 7, 7)), 1.0F);
    wide->tree().setValue({55, 0, 0}, 1e-6F);
    EXPECT_EQ(loadGrid(wide).volume.size.x, 58);
}

TEST_F(Values, AnAveragedGridSaysWhatToDo) {
    const auto full = makeGrid();
    full->fill(openvdb::CoordBBox(Coord(0), Coord(63)), 1.0F);
    vdb::LoadOptions options;
    options.memoryBudgetMiB = 0.25;
    // 66³ voxels of 2 bytes
    EXPECT_THAT(loadGrid(full, options).warnings, ElementsAre(HasSubstr("preparation.memory_budget = 1 keeps all")));
    options.memoryBudgetMiB = 512.0;
    options.maxExtent = 32;
    EXPECT_THAT(loadGrid(full, options).warnings, ElementsAre(HasSubstr("one [[cloud]] each")));
    const auto apart = makeGrid();
    apart->tree().setValue({0, 0, 0}, 1.0F);
    apart->tree().setValue({100000, 0, 0}, 1.0F);
    EXPECT_THAT(loadGrid(apart).warnings,
                ElementsAre(AllOf(HasSubstr("2e-05 of the box holds density"), HasSubstr("one [[cloud]] each"))));
}

}  // namespace
}  // namespace lumulus::test
