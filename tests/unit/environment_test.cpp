#include "sky/environment.h"

#include <gtest/gtest.h>

#include <numbers>

#include "scene/sunlight.h"

namespace lumulus::sky {
namespace {

using glm::dvec3;

scene::Sky constant(const dvec3& radiance) {
    scene::Sky sky;
    sky.radiance = radiance;
    return sky;
}

TEST(Environment, ConstantSkyIsTheSameFromEverywhere) {
    const Environment sky(constant({0.1, 0.2, 0.4}));
    const scene::Sun sun;
    EXPECT_EQ(sky.radiance({0, 0, 0}, {0, 1, 0}, sun), dvec3(0.1, 0.2, 0.4));
    EXPECT_EQ(sky.radiance({0, 9, 0}, {0.6, -0.8, 0}, sun), dvec3(0.1, 0.2, 0.4));
    EXPECT_EQ(sky.meanRadiance({0, 9, 0}, sun), dvec3(0.1, 0.2, 0.4));
    EXPECT_EQ(sky.atmosphere(), nullptr);
    EXPECT_EQ(shared::environmentRadiance(sky.params(), {0, 0, 1}), glm::vec3(0.1F, 0.2F, 0.4F));
    EXPECT_EQ(sky.sunTransmittance({5, 6, 7}, {0, 1, 0}), dvec3(1.0));
    const AerialPerspective air = sky.between({0, 0, 0}, {1e6, 0, 0}, sun);
    EXPECT_EQ(air.radiance, dvec3(0.0));
    EXPECT_EQ(air.transmittance, dvec3(1.0));
    EXPECT_FALSE(sky.isDark(sun));
    EXPECT_TRUE(Environment(constant(dvec3(0.0))).isDark(sun));
}

/// The mean of radiance · cosine / density over a hemisphere is the irradiance π L: a midpoint rule of 64² samples.
TEST(Environment, SamplesIntegrateToTheIrradiance) {
    const Environment sky(constant(dvec3(2.0)));
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
    EXPECT_NEAR(Environment(constant(dvec3(0.5))).fluxThrough(faces).y, 0.5 * std::numbers::pi * 22.0, 1e-12);
}

/// Mean cosine of directions that enter a face: 2/3.
TEST(Environment, DirectionsThroughAFaceFollowTheCosine) {
    double sum = 0.0;
    constexpr int count = 10000;
    for (int i = 0; i < count; ++i)
        sum += 1.0 - static_cast<double>(shared::environmentOneMinusCos((static_cast<float>(i) + 0.5F) / count));
    EXPECT_NEAR(sum / count, 2.0 / 3.0, 1e-4);
}

/// An atmosphere scales with the sun's irradiance above it, and its sunlight is that of the air.
TEST(Environment, AtmosphereIsLitByTheSun) {
    scene::Sky sky;
    sky.model = scene::SkyModel::atmosphere;
    const Environment environment(sky);
    scene::Sun sun;
    sun.irradiance = scene::sunAboveAir;
    const dvec3 here(0, 2, 0), up(0, 1, 0);
    const dvec3 seen = environment.radiance(here, up, sun), mean = environment.meanRadiance(here, sun);
    EXPECT_GT(seen.b, seen.r);
    EXPECT_GT(mean.g, seen.g);  // the horizon is brighter than the zenith
    EXPECT_NEAR(environment.sunTransmittance(here, sun.directionTo).g, 0.7, 0.1);
    const AerialPerspective far = environment.between(here, {20e3, 500, 0}, sun);
    EXPECT_LT(far.transmittance.b, far.transmittance.r);
    EXPECT_GT(far.radiance.b, far.radiance.r);
    EXPECT_EQ(environment.between(here, here, sun).transmittance, dvec3(1.0));
    const dvec3 above = environment.atmosphere()->sunAbove();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(above[c], scene::sunAboveAir[c], 1e-9);
    EXPECT_EQ(environment.params().radiance, glm::vec3(0.0F));
    sun.irradiance *= 0.5;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(environment.radiance(here, up, sun)[c], 0.5 * seen[c], 1e-9 * seen[c]);
    sun.irradiance = dvec3(0.0);
    EXPECT_TRUE(environment.isDark(sun));
}

}  // namespace
}  // namespace lumulus::sky
