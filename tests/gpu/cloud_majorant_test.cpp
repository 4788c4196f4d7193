#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cloud/asset.h"
#include "support/cloud_cases.h"
#include "support/field.h"
#include "support/vulkan_fixture.h"

namespace lumulus::cloud {
namespace {

using glm::dvec3;
using glm::ivec3;
using CloudMajorants = test::VulkanTest;

/// The interpolation on the host rounds too.
constexpr double rounding = 1e-14;

/// A point of the volume whose coordinates lie anywhere, on voxel faces, at voxel centres or on faces of cells.
dvec3 probe(std::mt19937& random, const ivec3& size) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    dvec3 point;
    for (int axis = 0; axis < 3; ++axis) {
        const double place = uniform(random) * size[axis];
        const double kind = uniform(random);
        point[axis] = kind < 0.4   ? place
                      : kind < 0.6 ? std::round(place)
                      : kind < 0.8 ? std::floor(place) + 0.5
                                   : std::min(8.0 * std::round(place / 8.0), double(size[axis]));
    }
    return point;
}

/// First and last cell whose closed box holds the coordinate.
std::pair<int, int> touching(double place, double cellSize, int cells) {
    const double cell = place / cellSize;
    const int upper = std::min(static_cast<int>(std::floor(cell)), cells - 1);
    return {std::max(cell == std::floor(cell) ? upper - 1 : upper, 0), upper};
}

/// Smallest majorant of the grid's cells that touch the point.
float gridMajorant(const MajorantGrid& grid, const dvec3& point) {
    std::pair<int, int> range[3];
    for (int axis = 0; axis < 3; ++axis)
        range[axis] = touching(point[axis], static_cast<double>(grid.cellSize[axis]), grid.cells[axis]);
    float least = INFINITY;
    for (int z = range[2].first; z <= range[2].second; ++z)
        for (int y = range[1].first; y <= range[1].second; ++y)
            for (int x = range[0].first; x <= range[0].second; ++x)
                least =
                    std::min(least, grid.maxima[static_cast<std::size_t>((z * grid.cells.y + y) * grid.cells.x + x)]);
    return least;
}

/// Against a search through all cells; a grid that is empty, full, or one cell thick among them.
TEST(MajorantDistances, AreThoseOfASearch) {
    std::mt19937 random(3);
    for (const auto& [cells, share] : std::vector<std::pair<ivec3, double>>{
             {{9, 7, 11}, 0.01}, {{9, 7, 11}, 0.2}, {{13, 1, 6}, 0.05}, {{5, 5, 5}, 0.0}, {{4, 3, 2}, 1.0}}) {
        MajorantGrid grid;
        grid.cells = cells;
        std::vector<ivec3> filled;
        for (int i = 0; i < cells.x * cells.y * cells.z; ++i) {
            grid.maxima.push_back(std::bernoulli_distribution(share)(random) ? 0.5F : 0.0F);
            if (grid.maxima.back() > 0.0F)
                filled.emplace_back(i % cells.x, (i / cells.x) % cells.y, i / (cells.x * cells.y));
        }
        const std::vector<float> found = majorantsAndDistances(grid);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const int n = static_cast<int>(i);
            const ivec3 cell(n % cells.x, (n / cells.x) % cells.y, n / (cells.x * cells.y));
            int least = cells.x + cells.y + cells.z;
            for (const ivec3& other : filled) {
                const ivec3 away = glm::abs(other - cell);
                least = std::min(least, std::max(away.x, std::max(away.y, away.z)));
            }
            ASSERT_EQ(found[i], least == 0 ? 0.5F : static_cast<float>(-least));
        }
    }
}

TEST_F(CloudMajorants, GridIsNeverBelowTheDensity) {
    for (const test::CloudCase& c : test::cloudCases()) {
        const test::Field field(c.volume);
        for (const scene::Majorant kind : {scene::Majorant::local, scene::Majorant::global}) {
            SCOPED_TRACE(c.name);
            const Asset cloud = prepare(context, c.volume, test::prepareOptions(500, kind));
            EXPECT_EQ(cloud.majorants.maxima.size() == 1, kind == scene::Majorant::global);
            std::mt19937 random(1);
            for (int i = 0; i < 100'000; ++i) {
                const dvec3 point = probe(random, field.size());
                ASSERT_GE(static_cast<double>(gridMajorant(cloud.majorants, point)), field.at(point) - rounding);
            }
        }
    }
}

/// A leaf's majorant covers its closed box; a leaf without a collector is empty.
TEST_F(CloudMajorants, LeavesAreNeverBelowTheDensity) {
    for (const test::CloudCase& c : test::cloudCases()) {
        SCOPED_TRACE(c.name);
        const test::Field field(c.volume);
        const Asset cloud = prepare(context, c.volume, test::prepareOptions(2000));
        std::vector<float> majorants(cloud.tree.leaves.size(), 0.0F);
        for (const Collector& collector : cloud.collectors)
            majorants[static_cast<std::size_t>(cloud.tree.find(collector.box.lower))] = collector.majorant;
        std::mt19937 random(2);
        for (int i = 0; i < 100'000; ++i) {
            const dvec3 point = probe(random, field.size());
            const double density = field.at(point);
            for (int corner = 0; corner < 8; ++corner) {
                const dvec3 away(corner & 1, (corner >> 1) & 1, corner >> 2);
                const ivec3 voxel = glm::clamp(ivec3(glm::floor(point - 1e-9 * away)), ivec3(0), field.size() - 1);
                ASSERT_GE(static_cast<double>(majorants[static_cast<std::size_t>(cloud.tree.find(voxel))]),
                          density - rounding);
            }
        }
    }
}

/// Not so high that it would be useless: within the slack of the largest texel that its cell's interpolation sees.
TEST_F(CloudMajorants, GridIsTight) {
    const test::CloudCase c = test::cloudCases()[1];
    const test::Field field(c.volume);
    const Asset cloud = prepare(context, c.volume, test::prepareOptions(500, scene::Majorant::local));
    const MajorantGrid& grid = cloud.majorants;
    double volume = 0.0, tentative = 0.0;
    for (int z = 0; z < grid.cells.z; ++z)
        for (int y = 0; y < grid.cells.y; ++y)
            for (int x = 0; x < grid.cells.x; ++x) {
                const ivec3 lower = ivec3(glm::vec3(x, y, z) * grid.cellSize);
                const ivec3 upper = glm::min(lower + ivec3(grid.cellSize), field.size());
                double largest = 0.0;
                for (int k = lower.z - 1; k <= upper.z; ++k)
                    for (int j = lower.y - 1; j <= upper.y; ++j)
                        for (int i = lower.x - 1; i <= upper.x; ++i)
                            largest = std::max(largest, field.texel({i, j, k}));
                const float majorant = grid.maxima[static_cast<std::size_t>((z * grid.cells.y + y) * grid.cells.x + x)];
                ASSERT_NEAR(static_cast<double>(majorant), largest, 2e-5);
                const dvec3 extent = dvec3(upper - lower);
                volume += extent.x * extent.y * extent.z;
                tentative += largest * extent.x * extent.y * extent.z;
            }
    EXPECT_DOUBLE_EQ(volume, double(field.size().x) * field.size().y * field.size().z);
    EXPECT_NEAR(grid.nullCollisions, tentative / field.sumOfTexels() - 1.0, 1e-3);
}

/// The choice is a computed ratio and no stopwatch: a full box walks with one majorant, a spike with many.
TEST_F(CloudMajorants, AutomaticChoiceFollowsTheNullCollisions) {
    const auto cases = test::cloudCases();
    EXPECT_EQ(prepare(context, cases[0].volume, test::prepareOptions(100)).majorants.maxima.size(), 1U);
    EXPECT_GT(prepare(context, cases[3].volume, test::prepareOptions(100)).majorants.maxima.size(), 1U);
}

}  // namespace
}  // namespace lumulus::cloud
