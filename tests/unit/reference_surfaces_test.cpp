#include "reference/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumulus::reference {
namespace {

using glm::dvec3;

scene::Surface plane(double height) {
    scene::Surface surface;
    surface.position = dvec3(7.0, height, -3.0);
    return surface;
}

scene::Surface ball(const dvec3& middle, double radius) {
    scene::Surface surface;
    surface.kind = scene::SurfaceKind::sphere;
    surface.position = middle;
    surface.radius = radius;
    return surface;
}

scene::Surface disc(double height, double radius) {
    scene::Surface surface = plane(height);
    surface.kind = scene::SurfaceKind::disc;
    surface.position = dvec3(0.0, height, 0.0);
    surface.radius = radius;
    return surface;
}

TEST(Surfaces, TheNearestIsMet) {
    const Surfaces surfaces({plane(0.0), ball({0.0, 5.0, 0.0}, 2.0), disc(9.0, 1.0)});
    const auto at = [&](double x) { return *surfaces.nearest({{x, 20.0, 0.0}, {0.0, -1.0, 0.0}}, Surfaces::none); };
    EXPECT_EQ(at(0.0).surface, 2U);
    EXPECT_DOUBLE_EQ(at(0.0).metres, 11.0);
    EXPECT_EQ(at(1.5).surface, 1U);
    EXPECT_NEAR(at(1.5).metres, 15.0 - std::sqrt(4.0 - 1.5 * 1.5), 1e-12);
    EXPECT_EQ(at(2.5).surface, 0U);
    EXPECT_DOUBLE_EQ(at(2.5).metres, 20.0);
    EXPECT_FALSE(surfaces.nearest({{0.0, 20.0, 0.0}, {0.0, 1.0, 0.0}}, Surfaces::none)) << "behind the ray";
    EXPECT_FALSE(surfaces.block({{5.0, 1.0, 0.0}, {1.0, 0.0, 0.0}}, Surfaces::none)) << "along the plane";
}

TEST(Surfaces, ARayDoesNotMeetWhatItLeavesButMayMeetItsOtherSide) {
    const Surfaces surfaces({plane(0.0), ball({1e6, 5.0, 0.0}, 2.0)});
    EXPECT_FALSE(surfaces.block({{0.0, -1e-13, 0.0}, {0.0, 1.0, 0.0}}, 0));
    EXPECT_TRUE(surfaces.block({{0.0, -1e-13, 0.0}, {0.0, 1.0, 0.0}}, Surfaces::none));
    const dvec3 top(1e6, 7.0, 0.0);
    EXPECT_FALSE(surfaces.block({top, glm::normalize(dvec3(3.0, 0.1, 0.0))}, 1));
    const auto inside = surfaces.nearest({top, {0.0, -1.0, 0.0}}, 1);
    ASSERT_TRUE(inside);
    EXPECT_EQ(inside->surface, 1U);
    EXPECT_DOUBLE_EQ(inside->metres, 4.0);
}

TEST(Surfaces, NormalsFaceWhereARayComesFrom) {
    const Surfaces surfaces({plane(0.0), ball({0.0, 5.0, 0.0}, 2.0)});
    EXPECT_EQ(surfaces.normalAgainst({0.0, -1.0, 0.0}, dvec3(0.0), 0), dvec3(0.0, 1.0, 0.0));
    EXPECT_EQ(surfaces.normalAgainst({0.6, 0.8, 0.0}, dvec3(0.0), 0), dvec3(0.0, -1.0, 0.0));
    EXPECT_EQ(surfaces.normalAgainst({0.0, 0.0, -1.0}, {0.0, 5.0, 2.0}, 1), dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(surfaces.normalAgainst({0.0, 0.0, 1.0}, {0.0, 5.0, 2.0}, 1), dvec3(0.0, 0.0, -1.0));
}

}  // namespace
}  // namespace lumulus::reference
