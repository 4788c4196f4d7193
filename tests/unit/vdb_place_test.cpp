// Where a grid is and how thick: what `lumulus info` shows.
#include <gmock/gmock.h>

#include <limits>

#include "unit/vdb_grids.h"
#include "vdb/describe.h"

namespace lumulus::test {
namespace {

using Place = GridFiles;
using openvdb::Coord;

/// 4 × 2 × 3 voxels of density 0.5 from (0, 0, 0) on.
openvdb::FloatGrid::Ptr makeBox(const openvdb::Mat4d& rows) {
    const auto grid = makeGrid();
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(3, 1, 2)), 0.5F);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(rows));
    return grid;
}

vdb::GridInfo infoOf(const std::filesystem::path& path) {
    return vdb::describe(path).at(0);
}

void expectAt(const glm::dvec3& actual, const glm::dvec3& expected) {
    EXPECT_NEAR(glm::distance(actual, expected), 0.0, 1e-6) << actual.x << " " << actual.y << " " << actual.z;
}

TEST_F(Place, BoxInMetres) {
    const auto grid = makeBox({10, 0, 0, 0, 0, 20, 0, 0, 0, 0, 30, 0, 500000, 1000, 4649776, 1});
    const auto info = infoOf(save({grid}));
    ASSERT_TRUE(info.place);
    expectAt(info.place->minimum, {500000 - 5, 1000 - 10, 4649776 - 15});
    expectAt(info.place->maximum, {500000 + 35, 1000 + 30, 4649776 + 75});
    EXPECT_FALSE(info.place->mirrored);
    EXPECT_FALSE(info.place->rotated);
    expectAt(info.place->toWorld.point({3, 1, 2}), {500030, 1020, 4649836});
}

TEST_F(Place, MirroredAndRotated) {
    auto info = infoOf(save({makeBox({-10, 0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 0, 0, 1})}));
    EXPECT_TRUE(info.place->mirrored);
    EXPECT_FALSE(info.place->rotated);
    expectAt(info.place->minimum, {-35, -5, -5});
    // z up: y of the grid goes along z, z along −y
    info = infoOf(save({makeBox({10, 0, 0, 0, 0, 0, 10, 0, 0, -10, 0, 0, 0, 0, 0, 1})}));
    EXPECT_FALSE(info.place->mirrored);
    EXPECT_TRUE(info.place->rotated);
    expectAt(info.place->minimum, {-5, -25, -5});
    expectAt(info.place->maximum, {35, 5, 15});
}

TEST_F(Place, OpticalThicknessAlongTheAxes) {
    const auto grid = makeBox({10, 0, 0, 0, 0, 20, 0, 0, 0, 0, 30, 0, 0, 0, 0, 1});
    grid->tree().setValue({0, 0, 0}, 4.5F);
    const auto info = infoOf(save({grid}));
    ASSERT_TRUE(info.thickness);
    // x: 6 columns of 4 · 0.5 · 10 m, and 40 m more in one of them
    expectAt(info.thickness->largest, {20 + 40, 20 + 80, 45 + 120});
    expectAt(info.thickness->mean, {20 + 40.0 / 6, 20 + 80.0 / 12, 45 + 120.0 / 8});
    EXPECT_EQ(info.activeVoxels, 24U);
    ASSERT_TRUE(info.values);
    EXPECT_NEAR(info.values->mean, (23 * 0.5 + 4.5) / 24, 1e-12);
}

TEST_F(Place, TilesAndBadValues) {
    const auto solid = makeGrid();
    solid->sparseFill(openvdb::CoordBBox(Coord(0), Coord(127)), 1.0F);
    auto info = infoOf(save({solid}));
    ASSERT_TRUE(info.thickness);
    expectAt(info.thickness->largest, glm::dvec3(128));
    expectAt(info.thickness->mean, glm::dvec3(128));
    const auto bad = makeBlob({0, 0, 0});
    bad->tree().setValue({1, 1, 1}, std::numeric_limits<float>::quiet_NaN());
    info = infoOf(save({bad}));
    EXPECT_FALSE(info.thickness);
    EXPECT_EQ(info.values->notFinite, 1U);
    EXPECT_EQ(info.values->maximum, 0.5);
}

}  // namespace
}  // namespace lumulus::test
