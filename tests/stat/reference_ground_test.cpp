#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/ground.h"
#include "reference/tracer.h"
#include "stat/ball.h"
#include "support/statistics.h"

// The ground below the clouds: it blocks, reflects and receives shadows.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double ballRadius = 10.0;
constexpr dvec3 albedo(0.8, 0.5, 0.2);

/// A ground 20 m below the origin under a sky of one colour, without sun.
scene::Scene groundScene() {
    scene::Scene scene;
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.3, 1.0, 7.0);
    scene.ground = scene::Ground{albedo, -20.0};
    return scene;
}

struct Seen {
    dvec3 mean{0.0}, error{0.0};
};

Seen seen(const scene::Scene& scene, const Ray& ray, int samples, const std::vector<vdb::PlacedVolume>& volumes = {}) {
    const PathTracer tracer(scene, volumes, Majorant::local);
    Random random(31, 0, 0);
    RunningMean mean[3];
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(ray, random);
        for (int c = 0; c < 3; ++c) mean[c].add(sample.radiance[c] + sample.passed[c] * tracer.environment().unit()[c]);
    }
    return {{mean[0].mean(), mean[1].mean(), mean[2].mean()},
            {mean[0].standardError(), mean[1].standardError(), mean[2].standardError()}};
}

void expectNear(const Seen& found, const dvec3& expected, double relative = 1e-12) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 4.0 * found.error[c] + relative * expected[c]) << "channel " << c;
}

/// Down and to the side, so that the ball about the origin is not on the way.
const Ray slanting{{300.0, 80.0, -40.0}, glm::normalize(dvec3(0.3, -1.0, 0.2))};

/// A white ground and a cloud that only scatters, in a sky of one colour, are not seen.
TEST(ReferenceGround, WhiteFurnaceIsExact) {
    scene::Scene scene = groundScene();
    scene.ground->albedo = dvec3(1.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.5;
    const vdb::Volume ball = ballVolume(24, ballRadius);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    Random random(32, 0, 0);
    int scattered = 0;
    for (int i = 0; i < 3000; ++i) {
        const Ray ray{{0.006 * i - 9.0, 50.0, 0.0}, {0.0, -1.0, 0.0}};
        const PathSample sample = tracer.trace(ray, random);
        scattered += sample.passed.x > 0.0 ? 0 : 1;
        EXPECT_EQ(sample.passed * scene.sky.radiance + sample.radiance, scene.sky.radiance);
        EXPECT_FALSE(sample.lost);
    }
    EXPECT_EQ(scattered, 3000) << "the ground lets nothing through";
}

/// An open ground has the radiance albedo/π (E cos θ + π L).
TEST(ReferenceGround, OpenGroundIsLambertUnderSunAndSky) {
    scene::Scene scene = groundScene();
    scene.sun.irradiance = dvec3(5.0, 4.0, 3.0);
    for (const double elevation : {75.0, 20.0}) {
        scene.sun.directionTo = scene::skyDirection(130.0, elevation);
        const dvec3 sun = scene.sun.irradiance * std::sin(glm::radians(elevation));
        expectNear(seen(scene, slanting, 10'000),
                   albedo / glm::pi<double>() * (sun + glm::pi<double>() * scene.sky.radiance));
    }
    scene.sun.directionTo = scene::skyDirection(130.0, -5.0);
    expectNear(seen(scene, slanting, 100), albedo * scene.sky.radiance);
}

/// In the middle of the shadow of an absorbing ball the sun is weaker by e^(−τ).
TEST(ReferenceGround, ReceivesTheShadowOfACloud) {
    scene::Scene scene = groundScene();
    scene.sky.radiance = dvec3(0.0);
    scene.sun.irradiance = dvec3(1.0);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 1.0, 0.0));
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 1.5 / (2.0 * ballRadius);
    scene.clouds[0].albedo = dvec3(0.0);
    const vdb::Volume ball = ballVolume(40, ballRadius);
    const Ray toShadow{{-20.0, 100.0, 0.0}, {0.0, -1.0, 0.0}};
    const dvec3 open = albedo / glm::pi<double>() * std::sqrt(0.5);
    expectNear(seen(scene, toShadow, 40'000, {ball}), std::exp(-1.5) * open, 0.003);
    expectNear(seen(scene, {{20.0, 100.0, 0.0}, {0.0, -1.0, 0.0}}, 100, {ball}), open);
}

/// Light of the ground reaches the base of a cloud: a ball of one scattering in the light of an endless bright plane,
/// which fills the lower half of its sky.
TEST(ReferenceGround, LightsTheBaseOfACloud) {
    scene::Scene scene = groundScene();
    scene.sky.radiance = dvec3(0.0);
    scene.sun.irradiance = dvec3(2.0);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = dvec3(0.0, 1.0, 0.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 1e-3;  // so thin that it shades nothing
    scene.clouds[0].phase.g = 0.0;
    const vdb::Volume ball = ballVolume(24, ballRadius);
    const Ray level{{0.0, 0.0, 50.0}, {0.0, 0.0, -1.0}};
    const PathTracer tracer(scene, {ball}, Majorant::local);
    const double collided = 1.0 - tracer.integrate(level).clear;
    // from the sun E/(4π), from the ground half of its radiance
    const dvec3 expected = collided * 2.0 * (dvec3(0.25) + 0.5 * albedo) / glm::pi<double>();
    const Seen found = seen(scene, level, 1'000'000, {ball});
    EXPECT_LT(found.error.x, 0.02 * expected.x);
    expectNear(found, expected, 0.02);
}

/// The ground has a depth, and it is a sphere below an atmosphere.
TEST(ReferenceGround, IsAPlaneOrASphere) {
    scene::Scene scene = groundScene();
    const Ray ray{{0.0, 5.0, 0.0}, glm::normalize(dvec3(3.0, -4.0, 0.0))};
    const PathTracer tracer(scene, {}, Majorant::local);
    EXPECT_NEAR(tracer.integrate(ray).distance, 25.0 / 0.8, 1e-9);
    EXPECT_EQ(tracer.integrate(ray).clear, 0.0);
    EXPECT_NEAR(*tracer.front(ray), 25.0 / 0.8, 1e-9);
    scene.ground.reset();
    EXPECT_TRUE(surfacesOf(scene).empty());
    scene.sky.model = scene::SkyModel::atmosphere;
    const Surfaces planet(surfacesOf(scene));
    // horizon of 2 m: d² = h (2R + h)
    const double distance = std::sqrt(2.0 * (2.0 * planetRadius + 2.0));
    const double dip = std::asin(distance / (planetRadius + 2.0));
    const auto from = [](double below) { return Ray{{0.0, 2.0, 0.0}, {std::cos(below), -std::sin(below), 0.0}}; };
    EXPECT_FALSE(planet.nearest(from(dip - 1e-7), Surfaces::none));
    ASSERT_TRUE(planet.nearest(from(dip + 1e-7), Surfaces::none));
    EXPECT_NEAR(planet.nearest({{0.0, 2.0, 0.0}, {0.0, -1.0, 0.0}}, Surfaces::none)->metres, 2.0, 1e-8);
}

}  // namespace
}  // namespace lumulus::reference
