#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "reference/tracer.h"
#include "stat/ball.h"
#include "stat/seen_light.h"
#include "support/statistics.h"

// Several clouds in the reference: what overlaps adds up, and what is apart shares its light.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double radius = 10.0;

scene::Scene sceneOf(int clouds, double extinction) {
    scene::Scene scene;
    scene.clouds.resize(static_cast<std::size_t>(clouds));
    for (scene::Cloud& cloud : scene.clouds) {
        cloud.extinction = extinction;
        cloud.phase.g = 0.5;
    }
    return scene;
}

/// Shares of one cloud at one place are that cloud: radiance by a z-test, transmittance and distance to rounding.
TEST(ReferenceClouds, SharesAtOnePlaceAreTheWhole) {
    const vdb::Volume ball = ballVolume(20, radius);
    const Ray ray{{3.0, 1.0, 50.0}, {0.0, 0.0, -1.0}};
    scene::Scene whole = sceneOf(1, 0.2);
    whole.clouds[0].albedo = dvec3(1.0, 0.9, 0.6);
    const Seen expected = seen(whole, {ball}, ray, 40'000, 1);
    const RayIntegrals line = PathTracer(whole, {ball}, Majorant::local).integrate(ray);
    for (const int n : {2, 8}) {
        scene::Scene parts = sceneOf(n, 0.2 / n);
        for (scene::Cloud& cloud : parts.clouds) cloud.albedo = whole.clouds[0].albedo;
        const std::vector<vdb::PlacedVolume> volumes(static_cast<std::size_t>(n), ball);
        const Seen found = seen(parts, volumes, ray, 40'000, static_cast<std::uint64_t>(n));
        for (std::size_t c = 0; c < 3; ++c) {
            const double error = std::hypot(found.channel[c].standardError(), expected.channel[c].standardError());
            EXPECT_NEAR(found.channel[c].mean(), expected.channel[c].mean(), 4.0 * error) << n << ", channel " << c;
        }
        const RayIntegrals lines = PathTracer(parts, volumes, Majorant::local).integrate(ray);
        EXPECT_NEAR(lines.clear, line.clear, 1e-12);
        EXPECT_NEAR(lines.distance, line.distance, 1e-9);
    }
}

/// The event is one of a cloud by its share of σt: half of the extinction that absorbs all is an albedo of a half.
TEST(ReferenceClouds, EachHasItsShareOfTheEvents) {
    const vdb::Volume ball = ballVolume(20, radius);
    const Ray ray{{0.0, 0.0, 50.0}, {0.0, 0.0, -1.0}};
    scene::Scene mixed = sceneOf(2, 0.1), grey = sceneOf(1, 0.2);
    mixed.clouds[1].albedo = dvec3(0.0);
    grey.clouds[0].albedo = dvec3(0.5);
    const Seen found = seen(mixed, {ball, ball}, ray, 60'000, 3), expected = seen(grey, {ball}, ray, 60'000, 4);
    for (std::size_t c = 0; c < 3; ++c) {
        const double error = std::hypot(found.channel[c].standardError(), expected.channel[c].standardError());
        EXPECT_NEAR(found.channel[c].mean(), expected.channel[c].mean(), 4.0 * error) << "channel " << c;
    }
}

TEST(ReferenceClouds, BallsApartMultiplyTheirTransmittances) {
    const vdb::Volume ball = ballVolume(20, radius);
    const vdb::PlacedVolume far = shifted(ball, {2.0, 0.0, -40.0});
    const Ray ray{{1.0, 0.0, 50.0}, {0.0, 0.0, -1.0}};
    const scene::Scene one = sceneOf(1, 0.03), both = sceneOf(2, 0.03);
    const RayIntegrals near = PathTracer(one, {ball}, Majorant::local).integrate(ray);
    const RayIntegrals behind = PathTracer(one, {far}, Majorant::local).integrate(ray);
    const PathTracer tracer(both, {far, ball}, Majorant::local);  // not in the order of the ray
    const RayIntegrals line = tracer.integrate(ray);
    EXPECT_NEAR(line.clear, near.clear * behind.clear, 1e-12);
    EXPECT_NEAR(line.distance, near.distance + near.clear * behind.distance, 1e-9);
    EXPECT_EQ(tracer.front(ray), PathTracer(one, {ball}, Majorant::local).front(ray));
    Random random(5, 0, 0);
    const Clouds clouds(both.clouds, {far, ball}, Majorant::local);
    RunningMean mean;
    for (int i = 0; i < 100'000; ++i) mean.add(clouds.passed(clouds.raysOf(ray), ray.direction, random, 1.0, 0.3));
    EXPECT_NEAR(mean.mean(), line.clear, 4.0 * mean.standardError());
}

/// Clouds that only scatter, in a sky of one colour, are not seen.
TEST(ReferenceClouds, TwoInAFurnaceAreNotSeen) {
    const vdb::Volume ball = ballVolume(20, radius);
    scene::Scene scene = sceneOf(2, 0.2);
    scene.clouds[1].phase.model = scene::PhaseModel::rayleigh;
    scene.clouds[1].extinction = 0.1;
    scene.sun.irradiance = dvec3(0.0);
    const Ray ray{{4.0, 0.0, 50.0}, {0.0, 0.0, -1.0}};
    const Seen found = seen(scene, {ball, shifted(ball, {8.0, 3.0, -12.0})}, ray, 5'000, 6);
    for (std::size_t c = 0; c < 3; ++c) {
        const double sky = scene.sky.radiance[static_cast<int>(c)];
        EXPECT_NEAR(found.channel[c].mean(), sky, 4.0 * found.channel[c].standardError() + 1e-12 * sky);
    }
}

}  // namespace
}  // namespace lumulus::reference
