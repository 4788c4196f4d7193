#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "reference/ground.h"
#include "reference/tracer.h"
#include "stat/ball.h"
#include "stat/scattered_once.h"
#include "support/deviation.h"
#include "support/statistics.h"

// Paths through the air of an atmosphere: known answers.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double pi = glm::pi<double>();

scene::Scene skyScene(double elevation) {
    scene::Scene scene;
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sun.directionTo = scene::skyDirection(0.0, elevation);
    scene.sun.irradiance = AirMedium::of(scene.sky).toRgb * Four(1.0);
    return scene;
}

struct Seen {
    dvec3 mean{0.0}, error{0.0};
};

/// Mean radiance along the rays that `rayOf` draws.
template <typename RayOf>
Seen meanOf(const AirTracer& tracer, int samples, std::uint64_t seed, const RayOf& rayOf) {
    Random random(seed, 0, 0);
    RunningMean mean[3];
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(rayOf(random), random);
        for (int c = 0; c < 3; ++c) mean[c].add(sample.radiance[c] + sample.passed[c]);
    }
    return {{mean[0].mean(), mean[1].mean(), mean[2].mean()},
            {mean[0].standardError(), mean[1].standardError(), mean[2].standardError()}};
}

double photometric(const dvec3& rgb) {
    return 683.0 * glm::dot(rgb, {0.2126, 0.7152, 0.0722});
}

TEST(ReferenceAir, OneScatteringAgreesWithQuadrature) {
    const AirMedium medium = AirMedium::of(scene::Sky{});
    const auto nothing = [](double, double) { return Four(0.0); };
    expectOneScatteringOfQuadrature(Air(medium, 0.0), medium, nothing, {60.0, 3.0}, 60'000, 41, 1e-5);
}

/// What does not collide has the transmittance at each wavelength.
TEST(ReferenceAir, PassesByItsTransmittance) {
    const Air air(AirMedium::of(scene::Sky{}), 0.0);
    const Four throughput(2.0, 1.0, 0.5, 0.25);
    Random random(42, 0, 0);
    const Ray ray{{0.0, 50.0, 0.0}, scene::skyDirection(40.0, 8.0)};
    for (const double metres : {20e3, endless}) {
        const Four expected = throughput * air.transmittance(ray, metres);
        RunningMean mean[4];
        for (int i = 0; i < 60'000; ++i) {
            const bool collided = air.collide(ray, metres, throughput, random).has_value();
            const Four light = collided ? Four(0.0) : air.passed(ray, metres, throughput);
            for (int c = 0; c < 4; ++c) mean[c].add(light[c]);
        }
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(mean[c].mean(), expected[c], 4.0 * mean[c].standardError());
    }
}

/// Air that only scatters, a white ground and a white cloud in light from everywhere are not seen: two suns that each
/// fill a half of the sky add up to a radiance of 1/π in any direction, at any height.
TEST(ReferenceAir, WhiteFurnace) {
    scene::Scene scene = skyScene(90.0);
    scene.sky.aerosolDepth = scene.sky.ozone = 0.0;
    scene.sky.groundAlbedo = dvec3(1.0);
    scene.sun.angularDiameter = 180.0;
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 2e-3;
    const vdb::Volume ball = ballVolume(12, 2000.0);
    const vdb::PlacedVolume cloud{ball, {ball.toWorld.linear, ball.toWorld.translation + dvec3(0.0, 4000.0, 0.0)}};
    const AirTracer above(scene, {cloud}, Majorant::local);
    scene.sun.directionTo = -scene.sun.directionTo;
    const AirTracer below(scene, {cloud}, Majorant::local);
    const Ray rays[] = {{{0.0, 2.0, 0.0}, scene::skyDirection(30.0, 40.0)},
                        {{0.0, 2.0, 0.0}, scene::skyDirection(30.0, 0.3)},
                        {{0.0, 9000.0, 0.0}, scene::skyDirection(0.0, -80.0)},
                        {{0.0, 3000e3, 3000e3}, glm::normalize(dvec3(0.0, -3600e3, -3000e3))}};
    for (const Ray& ray : rays) {
        const auto same = [&](Random&) { return ray; };
        const Seen a = meanOf(above, 20'000, 43, same), b = meanOf(below, 20'000, 44, same);
        const dvec3 found = a.mean + b.mean + above.discSeen(ray) + below.discSeen(ray);
        const dvec3 expected = above.environment().rgb(Four(1.0 / pi));
        for (int c = 0; c < 3; ++c) {
            const double error = std::hypot(a.error[c], b.error[c]);
            EXPECT_NEAR(found[c], expected[c], 4.0 * error) << "direction " << ray.direction.y << ", channel " << c;
            EXPECT_LT(error, 0.01 * expected[c]);
        }
    }
}

/// The sun at an air mass of 1.5 (41.81°): 98.5 klx, chromaticity .341 .350, of an even disc and of one with a dark
/// rim.
TEST(ReferenceAir, TheSunHasItsIlluminance) {
    for (const bool limb : {false, true}) {
        scene::Scene scene = skyScene(41.81);
        scene.sun.limbDarkening = limb;
        const AirTracer tracer(scene, {}, Majorant::local);
        const SunDisc& sun = tracer.environment().sun();
        Random random(45, 0, 0);
        RunningMean mean[3];
        for (int i = 0; i < 5000; ++i) {
            const dvec3 seen = tracer.discSeen({{0.0, 0.0, 0.0}, sun.sample(random)}) * 2.0 * pi * sun.cone();
            for (int c = 0; c < 3; ++c) mean[c].add(seen[c]);
        }
        const dvec3 rgb(mean[0].mean(), mean[1].mean(), mean[2].mean());
        EXPECT_NEAR(photometric(rgb), 98.5e3, 0.01 * 98.5e3);
        const dvec3 xyz = dvec3(0.4124, 0.2126, 0.0193) * rgb.x + dvec3(0.3576, 0.7152, 0.1192) * rgb.y +
                          dvec3(0.1805, 0.0722, 0.9505) * rgb.z;
        EXPECT_NEAR(xyz.x / (xyz.x + xyz.y + xyz.z), 0.341, 0.002);
        EXPECT_NEAR(xyz.y / (xyz.x + xyz.y + xyz.z), 0.350, 0.002);
    }
}

/// Luminance of the zenith and illuminance of the sky: values of a prototype that marched through tables, which keep
/// little of the aerosol's forward peak after the first scattering and are darker at the zenith.
TEST(ReferenceAir, SkiesHaveTheirLuminance) {
    struct Row {
        double elevation, zenith, sky;
    };
    for (const Row& row : {Row{60.0, 3737.0, 14.3e3}, Row{30.0, 1395.0, 11.6e3}, Row{10.0, 742.0, 6.6e3}}) {
        const AirTracer tracer(skyScene(row.elevation), {}, Majorant::local);
        const dvec3 eye(0.0, 2.0, 0.0);
        const Seen zenith = meanOf(tracer, 30'000, 46, [&](Random&) { return Ray{eye, dvec3(0.0, 1.0, 0.0)}; });
        EXPECT_NEAR(photometric(zenith.mean), row.zenith, 0.06 * row.zenith) << row.elevation;
        const Seen sky = meanOf(tracer, 30'000, 47, [&](Random& random) {
            return Ray{eye, turned({0.0, 1.0, 0.0}, 1.0 - std::sqrt(random.uniform()), random)};
        });
        EXPECT_NEAR(pi * photometric(sky.mean), row.sky, 0.04 * row.sky) << row.elevation;
    }
}

/// A thin cloud low in the air, lit by a sun that the air reddens: only what the air passes on, and the cloud's albedo
/// counts at its wavelengths. The air is taken out by comparing two albedos.
TEST(ReferenceAir, CloudsHaveTheirAlbedoAtEachWavelength) {
    scene::Scene scene = skyScene(30.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 1e-4;
    scene.sky.groundAlbedo = dvec3(0.0);
    const vdb::Volume ball = ballVolume(12, 1000.0);
    const vdb::PlacedVolume cloud{ball, {ball.toWorld.linear, ball.toWorld.translation + dvec3(0.0, 2000.0, 0.0)}};
    scene.clouds[0].albedo = dvec3(0.0);
    const Ray ray{{0.0, 2000.0, 6000.0}, {0.0, 0.0, -1.0}};
    const auto same = [&](Random&) { return ray; };
    const Seen dark = meanOf(AirTracer(scene, {cloud}, Majorant::local), 120'000, 48, same);
    scene.clouds[0].albedo = dvec3(0.0, 0.0, 1.0);
    const AirTracer tracer(scene, {cloud}, Majorant::local);
    const Seen blue = meanOf(tracer, 120'000, 49, same);
    const dvec3 added = blue.mean - dark.mean, colour = tracer.environment().air().toRgb[0];
    // light of 440 nm alone has the colour of the matrix's first column
    for (int c = 0; c < 2; ++c) {
        const double error = std::hypot(std::hypot(blue.error[c], dark.error[c]),
                                        std::hypot(blue.error[2], dark.error[2]) * colour[c] / colour[2]);
        EXPECT_NEAR(added[c], added[2] * colour[c] / colour[2], 4.0 * error);
    }
    EXPECT_GT(added[2], 20.0 * std::hypot(blue.error[2], dark.error[2]));
}

/// The scene's irradiance counts above the air and scales sky and disc by channel; a lamp keeps its colour, also where
/// there is no sun.
TEST(ReferenceAir, IrradianceScalesTheLightOfTheSunAlone) {
    scene::Scene scene = skyScene(30.0);
    const AirSky mean(scene);
    const Four light(0.1, 0.2, 0.3, 0.4);
    const dvec3 before = mean.rgb(light), emission(3.0, 2.0, 1.0);
    scene.sun.irradiance *= dvec3(2.0, 0.5, 1.0);
    const AirSky other(scene);
    EXPECT_NEAR(glm::distance(other.rgb(light), before * dvec3(2.0, 0.5, 1.0)), 0.0, 1e-12 * before.x);
    scene.sun.irradiance = dvec3(0.0);
    const AirSky night(scene);
    for (const AirSky* sky : {&mean, &other, &night})
        EXPECT_NEAR(glm::distance(sky->rgb(sky->emission(emission)), emission), 0.0, 1e-12);
    EXPECT_FALSE(night.sunny());
    EXPECT_EQ(night.discRadiance(scene.sun.directionTo), Four(0.0));
}

/// The disc with a dark rim: mean 1 over the disc, 0.3/0.805 at the rim, 1/0.805 in the middle.
TEST(ReferenceSunDisc, LimbDarkeningKeepsTheIrradiance) {
    scene::Sun sun;
    sun.limbDarkening = true;
    for (const double diameter : {0.53, 40.0}) {
        sun.angularDiameter = diameter;
        const SunDisc disc(sun);
        EXPECT_NEAR(disc.limb(disc.direction()), 1.0 / 0.805, 1e-12);
        Random random(50, 0, 0);
        EXPECT_NEAR(disc.limb(turned(disc.direction(), disc.cone(), random)), 0.3 / 0.805, 1e-5);
        RunningMean mean, irradiance;
        for (int i = 0; i < 100'000; ++i) {
            const dvec3 direction = disc.sample(random);
            mean.add(disc.limb(direction));
            irradiance.add(disc.fluence() * disc.limb(direction) * glm::dot(direction, disc.direction()));
        }
        EXPECT_NEAR(mean.mean(), 1.0, 4.0 * mean.standardError());
        EXPECT_NEAR(irradiance.mean(), 1.0, 4.0 * irradiance.standardError());
        EXPECT_NEAR(disc.meanRadiance() * 2.0 * pi * disc.cone(), disc.fluence(), 1e-12);
    }
}

}  // namespace
}  // namespace lumulus::reference
