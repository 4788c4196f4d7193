// The grid of several clouds: majorants bound the sum of densities everywhere, lists name all clouds, empty space is
// empty.
#include "cloud/merged_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "shared/world.h"
#include "support/cloud_cases.h"
#include "support/field.h"
#include "support/vulkan_fixture.h"

namespace lumulus::cloud {
namespace {

using glm::dvec3;
using glm::ivec3;

/// A cell as shaders find it.
struct Found {
    float majorant = 0.0F;
    std::vector<std::uint32_t> instances;
    int reach = 0;  // cells on each side that are as empty, at least
};

Found cellAt(const MergedGrid& grid, const ivec3& cell) {
    const ivec3 brick = cell / shared::MERGED_BRICK, within = cell % shared::MERGED_BRICK;
    const std::uint32_t number =
        grid.numbers[static_cast<std::size_t>((brick.z * grid.bricks.y + brick.y) * grid.bricks.x + brick.x)];
    if (number >= shared::EMPTY_BRICK)
        return {0.0F, {}, shared::MERGED_BRICK * (static_cast<int>(number - shared::EMPTY_BRICK) - 1)};
    const int place = (within.z * shared::MERGED_BRICK + within.y) * shared::MERGED_BRICK + within.x;
    const glm::uvec2 texel = grid.cells[number * shared::MERGED_BRICK_CELLS + static_cast<std::size_t>(place)];
    const float majorant = std::bit_cast<float>(texel.x);
    if (!(majorant > 0.0F)) return {0.0F, {}, static_cast<int>(-majorant) - 1};
    if (texel.y >= shared::SINGLE_INSTANCE) return {majorant, {texel.y - shared::SINGLE_INSTANCE}, 0};
    const auto first = grid.lists.begin() + texel.y;
    return {majorant, {first + 1, first + 1 + *first}, 0};
}

class MergedGridTest : public test::VulkanTest {};

TEST_F(MergedGridTest, BoundsAllCloudsAndLeavesNothingOut) {
    const vdb::Volume ball = ballVolume(21, 10.0), lumps = test::lumpyVolume({22, 25, 19}, glm::dmat3(1.3), 2);
    PrepareOptions options = test::prepareOptions(200);
    options.keepBlocks = true;
    const Asset first = prepare(context, ball, options), second = prepare(context, lumps, options);
    const glm::dmat3 turned(dvec3(0.8, 0.6, 0.0), dvec3(-0.6, 0.8, 0.0), dvec3(0.0, 0.0, 1.0));
    const std::vector<MergedSource> clouds{{&first, first.voxelToMetres, dvec3(-10.0), 0.5},
                                           {&second, turned * second.voxelToMetres, dvec3(5.0, -12.0, -9.0), 2.0},
                                           {&first, 0.5 * first.voxelToMetres, dvec3(300.0, 80.0, 0.0), 1.0}};
    const dvec3 lower(-40.0, -40.0, -40.0), upper(330.0, 110.0, 40.0);
    const MergedGrid grid = mergeGrids(clouds, lower, upper, mergedCellEdge(clouds, lower, upper));
    const std::vector<test::Field> fields{test::Field(ball), test::Field(lumps), test::Field(ball)};
    const ivec3 cells = grid.bricks * shared::MERGED_BRICK;
    int shared = 0;
    for (int i = 0; i < 120'000; ++i) {
        // points of a sequence that fills space evenly
        const dvec3 at =
            lower + (upper - lower) * glm::fract(dvec3(i) * dvec3(0.7548776662, 0.5698402910, 0.4301597090));
        const ivec3 cell = glm::min(ivec3((at - grid.origin) / grid.edge), cells - 1);
        const Found found = cellAt(grid, cell);
        double sum = 0.0;
        for (std::size_t k = 0; k < clouds.size(); ++k) {
            const dvec3 voxel = glm::inverse(clouds[k].voxelToMetres) * (at - clouds[k].origin);
            if (glm::any(glm::lessThan(voxel, dvec3(0.0))) ||
                glm::any(glm::greaterThan(voxel, dvec3(clouds[k].asset->size))))
                continue;
            const double density = fields[k].at(voxel);
            if (!(density > 0.0)) continue;
            sum += clouds[k].extinction * density;
            EXPECT_NE(std::ranges::find(found.instances, k), found.instances.end());
        }
        ASSERT_LE(sum, static_cast<double>(found.majorant) * (1.0 + 1e-3)) << i;
        shared += found.instances.size() > 1 ? 1 : 0;
    }
    EXPECT_GT(shared, 100) << "they overlap";
    // what is said to be empty around a cell is
    for (int i = 0; i < 20'000; ++i) {
        const ivec3 cell(glm::fract(dvec3(i) * dvec3(0.7548776662, 0.5698402910, 0.4301597090)) * dvec3(cells));
        const int reach = std::min(cellAt(grid, cell).reach, 12);
        for (int k = 0; k < 27 && reach > 0; ++k) {
            const ivec3 other = cell + reach * (ivec3(k % 3, k / 3 % 3, k / 9) - 1);
            if (glm::any(glm::lessThan(other, ivec3(0))) || glm::any(glm::greaterThanEqual(other, cells))) continue;
            EXPECT_EQ(cellAt(grid, other).majorant, 0.0F);
        }
    }
}

/// A cloud of a millionth of the size, or one 5,000 km away, does not make a grid of millions of cells or bricks.
TEST_F(MergedGridTest, SpecksAndDistanceAskForNoMore) {
    PrepareOptions options = test::prepareOptions(200);
    options.keepBlocks = true;
    const Asset ball = prepare(context, ballVolume(21, 10.0), options);
    const auto edgeOf = [&](const std::vector<MergedSource>& clouds, const dvec3& upper) {
        return mergedCellEdge(clouds, dvec3(-10.0), upper);
    };
    const MergedSource one{&ball, ball.voxelToMetres, dvec3(-10.0), 0.5};
    MergedSource speck = one, small = one, far = one;
    speck.voxelToMetres *= 1e-6;
    small.voxelToMetres *= 0.5;
    far.origin.x = 5e6;
    const double six = 6.0 * std::cbrt(ball.voxelVolume);
    EXPECT_DOUBLE_EQ(edgeOf({one, one}, dvec3(20.0)), six);
    EXPECT_NEAR(edgeOf({one, small}, dvec3(20.0)), 0.5 * six, 1e-12);
    EXPECT_GT(edgeOf({one, speck}, dvec3(20.0)), 1.0);
    const dvec3 upper(5e6, 5e6, 20.0);
    const double edge = edgeOf({one, far}, upper);
    EXPECT_LT(glm::compMul(glm::ceil((upper + 10.0) / (8.0 * edge))), 1e6);
}

}  // namespace
}  // namespace lumulus::cloud
