#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/air.h"
#include "reference/ground.h"
#include "reference/tracer.h"
#include "stat/ball.h"
#include "stat/scattered_once.h"
#include "support/statistics.h"

// Paths through fog in the air of an atmosphere: known answers.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double pi = glm::pi<double>();

/// Fog that thins out upwards and ends at a height of 2500 m.
scene::FogMedium hazeMedium() {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::exponential;
    medium.scattering = dvec3(1e-4, 2e-4, 4e-4);
    medium.absorption = dvec3(3e-5, 1e-5, 5e-5);
    medium.falloff = 1e-3;
    medium.g = 0.6;
    medium.bottom = 0.0;
    medium.top = 2500.0;
    return medium;
}

Air foggyAir(const AirMedium& medium) {
    scene::Fog fog;
    fog.media = {hazeMedium()};
    const auto spread = [&](const dvec3& rgb) { return medium.spread(rgb); };
    return {medium, 0.0, FogMedia<Four>(fog, spread, spread, 0.0)};
}

TEST(ReferenceFoggyAir, OneScatteringAgreesWithQuadrature) {
    const AirMedium medium = AirMedium::of(scene::Sky{});
    const Air air = foggyAir(medium);
    const scene::FogMedium fog = hazeMedium();
    const auto ofFog = [&](double height, double away) {
        const double density = height < fog.top ? std::exp(-fog.falloff * height) : 0.0;
        return density * medium.spread(fog.scattering) * air.phase(2).evaluate(away);
    };
    expectOneScatteringOfQuadrature(air, medium, ofFog, {60.0, 3.0, 0.0}, 40'000, 71, 1e-4);
}

scene::Scene skyScene() {
    scene::Scene scene;
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sun.directionTo = dvec3(0.0, 1.0, 0.0);
    scene.sun.irradiance = AirMedium::of(scene.sky).toRgb * Four(1.0);
    scene.fog.media = {hazeMedium()};
    return scene;
}

/// Air, fog, a cloud and a ground that absorb nothing, in light from everywhere, are not seen: two suns that each fill
/// a half of the sky add up to a radiance of 1/π in any direction, at any height.
TEST(ReferenceFoggyAir, WhiteFurnace) {
    scene::Scene scene = skyScene();
    scene.sky.aerosolDepth = scene.sky.ozone = 0.0;
    scene.sky.groundAlbedo = dvec3(1.0);
    scene.sun.angularDiameter = 180.0;
    scene.fog.media[0].absorption = dvec3(0.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 2e-3;
    const vdb::Volume ball = ballVolume(12, 600.0);
    const vdb::PlacedVolume cloud{ball, {ball.toWorld.linear, ball.toWorld.translation + dvec3(0.0, 2000.0, 0.0)}};
    const AirTracer above(scene, {cloud}, Majorant::local);
    scene.sun.directionTo = -scene.sun.directionTo;
    const AirTracer below(scene, {cloud}, Majorant::local);
    const dvec3 expected = above.environment().rgb(Four(1.0 / pi));
    for (const Ray& ray : {Ray{{0.0, 2.0, 0.0}, scene::skyDirection(30.0, 0.3)},
                           Ray{{0.0, 9000.0, 0.0}, scene::skyDirection(0.0, -80.0)}}) {
        Random random(72, 0, 0);
        RunningMean mean[3];
        for (int i = 0; i < 20'000; ++i) {
            dvec3 both = above.discSeen(ray) + below.discSeen(ray);
            for (const AirTracer* tracer : {&above, &below}) {
                const PathSample sample = tracer->trace(ray, random);
                EXPECT_FALSE(sample.lost);
                both += sample.radiance + sample.passed;
            }
            for (int c = 0; c < 3; ++c) mean[c].add(both[c]);
        }
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean[c].mean(), expected[c], 4.0 * mean[c].standardError()) << ray.direction.y << ' ' << c;
            EXPECT_LT(mean[c].standardError(), 0.015 * expected[c]);
        }
    }
}

/// Fog is a thing of its own in the layers, by its three channels, and air is not; a shell seen along the horizon has
/// an end.
TEST(ReferenceFoggyAir, TransmittanceIsThatOfTheFog) {
    scene::Scene scene = skyScene();
    scene.fog.media[0].kind = scene::MediumKind::homogeneous;
    scene.fog.media[0].top = 100.0;
    const dvec3 extinction = 0.1 * (scene.fog.media[0].scattering + scene.fog.media[0].absorption);
    scene.fog.media[0].scattering *= 0.1;
    scene.fog.media[0].absorption *= 0.1;
    const AirTracer tracer(scene, {}, Majorant::global);
    const double half = std::sqrt((2.0 * planetRadius + 150.0) * 50.0);  // level at 50 m: (R + 100)² − (R + 50)²
    const RayIntegrals line = tracer.integrate({{0.0, 50.0, 0.0}, {1.0, 0.0, 0.0}});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(line.transmittance[c], std::exp(-extinction[c] * half), 1e-7);
    EXPECT_EQ(line.clear, 1.0);
    const Ray ray{{0.0, 2.0, 0.0}, scene::skyDirection(30.0, 0.0)};
    Random random(73, 0, 0);
    int fog = 0, air = 0;
    for (int i = 0; i < 300; ++i) {
        const PathSample sample = tracer.trace(ray, random);
        fog += sample.radiance.y > 0.0 ? 1 : 0;
        air += sample.passed.y > 0.0 ? 1 : 0;
    }
    EXPECT_GT(fog, 30);
    EXPECT_GT(air, 30) << "what air sends before anything else belongs to the sky";
}

}  // namespace
}  // namespace lumulus::reference
