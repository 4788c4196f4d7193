// Where photons begin round several clouds.
#include "light/photon/entry_discs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "light/photon/entry_grid.h"

namespace lumulus::photon {
namespace {

using glm::dvec3;

TEST(AliasTable, HasTheSharesItWasMadeOf) {
    const std::vector<double> shares{0.5, 0.01, 0.04, 0.25, 0.2};
    const AliasTable table = makeAliasTable(shares);
    std::vector<double> found(shares.size(), 0.0);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        EXPECT_GE(table.keep[i], 0.0);
        EXPECT_LE(table.keep[i], 1.0);
        found[i] += table.keep[i] / 5.0;
        found[table.other[i]] += (1.0 - table.keep[i]) / 5.0;
    }
    for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_NEAR(found[i], shares[i], 1e-12);
}

TEST(EntryDiscs, ASphereShowsACircle) {
    const PlacedEllipsoid sphere{glm::dmat3(3.0), dvec3(1e6, 0.0, 0.0)};
    EXPECT_NEAR(sphere.meanArea(), 9.0 * std::numbers::pi, 1e-9);
    EXPECT_GE(sphere.largestArea(), 9.0 * std::numbers::pi);
    EXPECT_NEAR(glm::distance(sphere.reach(), dvec3(3.0)), 0.0, 1e-12);
}

/// A flat one shows its face from above, and the area that shaders compute is that of every direction.
TEST(EntryDiscs, AreaFollowsTheDirection) {
    const PlacedEllipsoid flat{glm::dmat3(dvec3(5.0, 0, 0), dvec3(0, 1.0, 0), dvec3(0, 0, 4.0)),
                               dvec3(10.0, 20.0, 30.0)};
    const std::vector<double> shares{1.0};
    const shared::EntryDisc disc = entryDiscs(std::vector{flat}, shares, dvec3(10.0, 0.0, 0.0)).front();
    const auto area = [&](const glm::vec3& direction) {
        const glm::vec4 along(direction, 0.0F);
        const glm::vec3 unit(glm::dot(disc.toUnit[0], along), glm::dot(disc.toUnit[1], along),
                             glm::dot(disc.toUnit[2], along));
        return disc.volume * glm::length(unit);
    };
    constexpr float pi = std::numbers::pi_v<float>;
    EXPECT_NEAR(area({0, 1, 0}), 20.0F * pi, 1e-4F);
    EXPECT_NEAR(area({1, 0, 0}), 4.0F * pi, 1e-4F);
    EXPECT_NEAR(area({0, 0, 1}), 5.0F * pi, 1e-4F);
    const glm::vec4 middle(0.0F, 20.0F, 30.0F, 1.0F);
    for (const glm::vec4& row : disc.toUnit) EXPECT_NEAR(glm::dot(row, middle), 0.0F, 1e-5F);
    EXPECT_EQ(disc.fromUnit[1].w, 20.0F);
}

/// Wherever a place of an ellipsoid is, the list of its cell names the ellipsoid; and there are no more cells than a
/// few dozen for each of them, also where two clouds lie 100 km apart.
TEST(EntryGrid, NamesTheEllipsoidsOfEachCell) {
    std::vector<PlacedEllipsoid> ellipsoids{
        {glm::dmat3(dvec3(300.0, 0, 0), dvec3(0, 100.0, 0), dvec3(0, 0, 200.0)), dvec3(100'000.0, 1000.0, 0.0)}};
    for (int i = 0; i < 30; ++i)
        ellipsoids.push_back({glm::dmat3(dvec3(60.0 + 9.0 * i, 30.0, 0), dvec3(-20.0, 80.0, 0), dvec3(0, 0, 90.0)),
                              5000.0 * glm::fract(dvec3(i) * dvec3(0.7548776662, 0.01, 0.4301597090))});
    dvec3 lower(1e9), upper(-1e9);
    for (const PlacedEllipsoid& one : ellipsoids) {
        lower = glm::min(lower, one.middle - one.reach());
        upper = glm::max(upper, one.middle + one.reach());
    }
    const EntryGrid grid = makeEntryGrid(ellipsoids, lower, upper);
    EXPECT_LT(grid.cells.x * grid.cells.y * grid.cells.z, 2000);
    for (std::size_t number = 0; number < ellipsoids.size(); ++number)
        for (int k = 0; k < 200; ++k) {
            const dvec3 ball = 2.0 * glm::fract(dvec3(k) * dvec3(0.7548776662, 0.5698402910, 0.4301597090)) - 1.0;
            if (glm::dot(ball, ball) > 1.0) continue;
            const dvec3 at = ellipsoids[number].middle + ellipsoids[number].axes * ball;
            const glm::ivec3 cell(glm::floor((at - lower) / grid.edge));
            const auto place = static_cast<std::size_t>((cell.z * grid.cells.y + cell.y) * grid.cells.x + cell.x);
            const auto first = grid.lists.begin() + grid.lists.at(place);
            EXPECT_NE(std::find(first, grid.lists.begin() + grid.lists.at(place + 1), number),
                      grid.lists.begin() + grid.lists.at(place + 1));
        }
}

}  // namespace
}  // namespace lumulus::photon
