#include "sky/environment.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lumulus::sky {
namespace {

using glm::dvec3;

TEST(Environment, ConstantSkyIsTheSameFromEverywhere) {
    const Environment sky(scene::Sky{{0.1, 0.2, 0.4}});
    EXPECT_EQ(sky.radiance({0, 1, 0}), dvec3(0.1, 0.2, 0.4));
    EXPECT_EQ(sky.radiance({0.6, -0.8, 0}), dvec3(0.1, 0.2, 0.4));
    EXPECT_EQ(shared::environmentRadiance(sky.params(), {0, 0, 1}), glm::vec3(0.1F, 0.2F, 0.4F));
    EXPECT_EQ(sky.sunTransmittance({5, 6, 7}, {0, 1, 0}), dvec3(1.0));
    const AerialPerspective air = sky.between({0, 0, 0}, {1e6, 0, 0});
    EXPECT_EQ(air.radiance, dvec3(0.0));
    EXPECT_EQ(air.transmittance, dvec3(1.0));
    EXPECT_FALSE(sky.isDark());
    EXPECT_TRUE(Environment(scene::Sky{dvec3(0.0)}).isDark());
}

/// The mean of radiance · cosine / density over a hemisphere is the irradiance π L: a midpoint rule of 64² samples.
TEST(Environment, SamplesIntegrateToTheIrradiance) {
    const Environment sky(scene::Sky{dvec3(2.0)});
    constexpr int side = 64;
    double irradiance = 0.0;
    for (int i = 0; i < side * side; ++i) {
        const EnvironmentSample s = sky.sample({(i % side + 0.5) / side, (i / side + 0.5) / side});
        ASSERT_NEAR(glm::length(s.direction), 1.0, 1e-12);
        irradiance += s.radiance.x * std::max(0.0, s.direction.y) / s.density / (side * side);
    }
    EXPECT_NEAR(irradiance, 2.0 * std::numbers::pi, 1e-3);
}

/// A box of 1 × 2 × 3 m has a surface of 22 m².
TEST(Environment, FluxIsThatOfTheWholeSurface) {
    const glm::dmat3 faces({6.0, 0, 0}, {0, 3.0, 0}, {0, 0, 2.0});
    EXPECT_NEAR(Environment(scene::Sky{dvec3(0.5)}).fluxThrough(faces).y, 0.5 * std::numbers::pi * 22.0, 1e-12);
}

/// Mean cosine of directions that enter a face: 2/3.
TEST(Environment, DirectionsThroughAFaceFollowTheCosine) {
    double sum = 0.0;
    constexpr int count = 10000;
    for (int i = 0; i < count; ++i)
        sum += 1.0 - static_cast<double>(shared::environmentOneMinusCos((static_cast<float>(i) + 0.5F) / count));
    EXPECT_NEAR(sum / count, 2.0 / 3.0, 1e-4);
}

}  // namespace
}  // namespace lumulus::sky
