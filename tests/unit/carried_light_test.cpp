// Light of one photon map in another one: known answers for clouds that stand still, move, and change.
#include "light/photon/carried_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "light/photon/nearest_points.h"
#include "shared/collision_estimator.h"

namespace lumulus::photon {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr int bands = 2;
constexpr std::uint32_t each = 3 * bands * bands;
const std::vector<Way> still{[](const dvec3&) { return dvec3(0.0); }};

/// A cloud of collectors anywhere in a box of cells, all of which have density.
CarriedPlan planOf(std::size_t collectors, const ivec3& cells, unsigned seed = 1, const dvec3& corner = dvec3(0.0)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    CarriedPlan plan;
    CarriedCloud& cloud = plan.clouds.emplace_back();
    constexpr int edge = 2;
    cloud.cells = {edge, cells};
    cloud.size = edge * cells;
    cloud.toCloud = {glm::dmat3(8.0), corner};
    for (std::size_t i = 0; i < collectors; ++i) {
        const dvec3 voxel(uniform(random), uniform(random), uniform(random));
        cloud.places.push_back(cloud.toCloud.point(voxel * dvec3(cloud.size)));
        cloud.masses.push_back(0.5 + uniform(random));
    }
    for (std::uint64_t i = 0; i < cloud.cells.count(); ++i) cloud.cellMasses.push_back(0.5 + uniform(random));
    cloud.estimatorBase = static_cast<std::uint32_t>(collectors) * each;
    plan.bands = bands;
    plan.axisBase = plan.groundBase = plan.counts = cloud.estimatorBase + shared::estimatorCounts(cells);
    plan.generations = 1.0;
    return plan;
}

std::size_t cellIndex(const ivec3& cells, const ivec3& cell) {
    return static_cast<std::size_t>((cell.z * cells.y + cell.y) * cells.x + cell.x);
}

/// Counts that mean the same light for each m² everywhere: `light` in each coefficient, in each cell, and along each
/// axis.
std::vector<std::int64_t> constantLight(const CarriedPlan& plan, double light) {
    const CarriedCloud& cloud = plan.clouds.front();
    std::vector<std::int64_t> counts(plan.counts);
    for (std::size_t i = 0; i < cloud.places.size(); ++i)
        for (std::uint32_t k = 0; k < each; ++k) counts[i * each + k] = std::llround(light * cloud.masses[i]);
    const ivec3 cells = cloud.cells.cells;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x) {
                const ivec3 cell(x, y, z);
                const double mass = cloud.cellMasses[cellIndex(cells, cell)];
                const std::uint32_t cube = cloud.estimatorBase + shared::cubePlace(cells, cell);
                counts[cube + shared::placeInCube(cell)] = std::llround(light * mass);
                for (std::uint32_t axis = 0; axis < 3; ++axis)
                    counts[cube + shared::CUBE_CELLS + axis] += std::llround(light * mass);
            }
    return counts;
}

std::vector<std::int64_t> anyLight(const CarriedPlan& plan) {
    std::mt19937_64 random(7);
    std::vector<std::int64_t> counts = constantLight(plan, 1e9);  // 0 where nothing is ever counted
    for (std::int64_t& count : counts)
        if (count != 0) count = static_cast<std::int64_t>(random() % 2000000000) - 1000000000;
    return counts;
}

TEST(CarriedLight, NearestPointsAreExact) {
    const CarriedPlan plan = planOf(500, {4, 4, 4});
    const std::vector<dvec3>& points = plan.clouds.front().places;
    const NearestPoints nearest(points);
    const CarriedPlan asked = planOf(50, {4, 4, 4}, 2);
    for (const dvec3& place : asked.clouds.front().places) {
        std::vector<double> squares;
        for (const dvec3& point : points) squares.push_back(glm::dot(point - place, point - place));
        const NearestPoints::Found found = nearest.near(place);
        ASSERT_EQ(found.count, 8);
        for (std::size_t k = 0; k < 8; ++k)
            EXPECT_NEAR(found.squares[k], glm::dot(points[found.numbers[k]] - place, points[found.numbers[k]] - place),
                        1e-9 * squares[0]);
        std::ranges::sort(squares);
        for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(found.squares[k], squares[k], 1e-9 * squares[7]);
    }
    EXPECT_EQ(NearestPoints(std::vector{dvec3(1.0), dvec3(2.0)}).near(dvec3(0.0)).count, 2);
}

/// What stands still has its counts, as often as there are generations of them.
TEST(CarriedLight, AStillCloudHasItsCounts) {
    const CarriedPlan plan = planOf(40, {6, 5, 4});
    const std::vector<std::int64_t> counts = anyLight(plan);
    EXPECT_EQ(carriedCounts(plan, counts, plan, still, 1.0, 1.0), counts);
    CarriedPlan many = plan;
    many.generations = 8.0;
    const std::vector<std::int64_t> aged = carriedCounts(many, counts, plan, still, 7.0, 1.0);
    for (std::size_t i = 0; i < counts.size(); ++i) ASSERT_LE(std::abs(8 * aged[i] - 7 * counts[i]), 8) << i;
}

/// A box that is another one, of which the cloud has moved by whole cells, whatever the corner of its voxels.
TEST(CarriedLight, ACloudThatMovesByCellsHasItsCounts) {
    const dvec3 way(48.0, -16.0, 32.0);
    const CarriedPlan before = planOf(40, {6, 5, 4}), now = planOf(40, {6, 5, 4}, 1, way);
    const std::vector<std::int64_t> counts = anyLight(before);
    const std::vector<Way> moved{[&](const dvec3&) { return way; }};
    EXPECT_EQ(carriedCounts(before, counts, now, moved, 1.0, 1.0), counts);
}

/// A constant stays one whatever moves whereto: also where there was nothing.
TEST(CarriedLight, ConstantLightStaysConstant) {
    const CarriedPlan before = planOf(60, {6, 5, 4}), now = planOf(90, {8, 4, 6}, 2, {-20.0, 9.0, 3.0});
    const std::vector<Way> swirl{[](const dvec3& p) { return dvec3(5.0 * std::sin(p.y), 3.0, 0.3 * p.x); }};
    constexpr double light = 1e9;
    const std::vector<std::int64_t> carried = carriedCounts(before, constantLight(before, light), now, swirl, 3.0, 0.5);
    const std::vector<std::int64_t> expected = constantLight(now, 1.5 * light);
    const std::uint32_t base = now.clouds.front().estimatorBase;
    for (std::size_t i = 0; i < base; ++i) ASSERT_LT(std::abs(carried[i] - expected[i]), 50) << i;
    // cells that come from outside have what collectors have, whose coefficients are another constant
    std::size_t inside = 0;
    for (std::size_t i = base; i < carried.size(); ++i)
        if (std::abs(carried[i] - expected[i]) < 50) ++inside;
    EXPECT_GT(inside, (carried.size() - base) / 4);
    for (std::size_t i = base; i < carried.size(); ++i) EXPECT_EQ(carried[i] > 0, expected[i] > 0) << i;
}

/// Light that changes evenly in space is found where it was, nearer than by the weights alone.
TEST(CarriedLight, EvenChangesStay) {
    const CarriedPlan before = planOf(400, {6, 6, 6}), now = planOf(50, {6, 6, 6}, 2);
    const auto lightAt = [](const dvec3& place) { return 1e9 * (1.0 + 0.01 * (place.x + place.y - place.z)); };
    std::vector<std::int64_t> counts(before.counts);
    for (std::size_t i = 0; i < 400; ++i)
        for (std::uint32_t k = 0; k < each; ++k)
            counts[i * each + k] =
                std::llround(lightAt(before.clouds.front().places[i]) * before.clouds.front().masses[i]);
    const std::vector<std::int64_t> carried = carriedCounts(before, counts, now, still, 1.0, 1.0);
    double error = 0.0;
    int inside = 0;
    for (std::size_t i = 0; i < 50; ++i) {
        const dvec3 place = now.clouds.front().places[i];
        if (glm::any(glm::lessThan(place, dvec3(16.0))) || glm::any(glm::greaterThan(place, dvec3(80.0)))) continue;
        const double expected = lightAt(place) * now.clouds.front().masses[i];
        error += std::abs(static_cast<double>(carried[i * each]) / expected - 1.0);
        ++inside;
    }
    EXPECT_GT(inside, 8);
    EXPECT_LT(error / inside, 0.015) << "the slope is 1 % a metre, and collectors lie 13 m apart";
}

/// Cells without density before have the light of the collectors: a fluence of 1 is a coefficient of Y of band 0.
TEST(CarriedLight, NewCellsHaveTheLightOfCollectors) {
    CarriedPlan before = planOf(60, {6, 5, 4});
    const CarriedPlan now = before;
    std::ranges::fill(before.clouds.front().cellMasses, 0.0);
    constexpr double light = 1e12, y0 = 0.28209479177387814;
    std::vector<std::int64_t> counts(before.counts);
    for (std::size_t i = 0; i < 60; ++i)
        for (std::uint32_t channel = 0; channel < 3; ++channel)
            counts[i * each + channel * bands * bands] = std::llround(light * y0 * before.clouds.front().masses[i]);
    const std::vector<std::int64_t> carried = carriedCounts(before, counts, now, still, 1.0, 1.0);
    const CarriedCloud& cloud = now.clouds.front();
    const ivec3 cell(3, 2, 1);
    const double mass = cloud.cellMasses[cellIndex(cloud.cells.cells, cell)];
    const std::uint32_t cube = cloud.estimatorBase + shared::cubePlace(cloud.cells.cells, cell);
    EXPECT_NEAR(static_cast<double>(carried[cube + shared::placeInCube(cell)]), light * mass, 1e-9 * light);
    for (std::uint32_t axis = 0; axis < 3; ++axis) EXPECT_EQ(carried[cube + shared::CUBE_CELLS + axis], 0);
}

TEST(CarriedLight, RingsAndGroundGoAlong) {
    CarriedPlan plan = planOf(10, {2, 2, 2});
    plan.axisCounts = 5;
    plan.groundBase = plan.axisBase + 50;
    plan.counts = plan.groundBase + 7;
    std::vector<std::int64_t> counts(plan.counts, 1000);
    const std::vector<std::int64_t> carried = carriedCounts(plan, counts, plan, still, 2.0, 1.0);
    EXPECT_THAT(std::vector(carried.begin() + plan.axisBase, carried.end()), testing::Each(2000));
}

TEST(CarriedLight, ANewCloudHasNoLight) {
    const CarriedPlan before = planOf(10, {2, 2, 2});
    CarriedPlan now = before;
    EXPECT_TRUE(hasLightFor(before, now));
    now.clouds.front().number = 1;
    EXPECT_FALSE(hasLightFor(before, now));
    now = before;
    now.bands = 3;
    EXPECT_FALSE(hasLightFor(before, now));
}

}  // namespace
}  // namespace lumulus::photon
