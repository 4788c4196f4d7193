#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/tracer.h"
#include "stat/ball.h"
#include "support/deviation.h"
#include "support/painted_map.h"
#include "support/statistics.h"

// A picture as the sky of the reference.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::Paint;
using test::painted;
using test::RunningMean;
using test::smooth;
using test::withSpot;

constexpr double pi = glm::pi<double>();

class ReferenceMap : public test::PaintedMapTest<SkyMap> {
  protected:
    scene::Scene sceneOf(int width, const Paint& paint) {
        scene::Scene scene;
        scene.sun.irradiance = dvec3(0.0);
        scene.sky = skyOf(painted(width, paint));
        return scene;
    }
};

TEST_F(ReferenceMap, LooksWhereThePictureSays) {
    scene::Sky sky = skyOf(painted(256, smooth));
    sky.mapSun = false;
    sky.mapScale = 3.0;
    for (const double rotation : {0.0, 90.0, -200.0}) {
        sky.mapRotation = rotation;
        const SkyMap map(sky);
        for (const double azimuth : {-170.0, 0.0, 33.0, 179.9})
            for (const double elevation : {-90.0, -20.0, 0.0, 70.0}) {
                const dvec3 expected = 3.0 * smooth(scene::skyDirection(azimuth, elevation));
                const dvec3 found = map.radiance(scene::skyDirection(azimuth + rotation, elevation));
                EXPECT_LT(glm::distance(found, expected), 0.03) << azimuth << " " << elevation;
            }
    }
}

/// Directions are drawn as densely as `density` says, and the mean of radiance over density is the map's integral.
TEST_F(ReferenceMap, SamplesByItsDensity) {
    scene::Sky sky =
        skyOf(painted(16, [](const dvec3& d) { return dvec3(std::max(0.0, d.x) + (d.y > 0.9 ? 5.0 : 0.0)); }));
    sky.mapSun = false;
    sky.mapRotation = 25.0;
    const SkyMap map(sky);
    constexpr int across = 12, bands = 6, samples = 200'000;
    std::vector<double> observed(across * bands), expected(across * bands);
    Random random(61, 0, 0);
    const auto binOf = [](const dvec3& d) {
        const int x = std::min(across - 1, static_cast<int>((0.5 + std::atan2(d.x, -d.z) / (2.0 * pi)) * across));
        const int y = std::min(bands - 1, static_cast<int>(0.5 * (1.0 + d.y) * bands));
        return static_cast<std::size_t>(y * across + x);
    };
    RunningMean integral, plain;
    for (int i = 0; i < samples; ++i) {
        const SkyMapSample sample = map.sample(random);
        EXPECT_NEAR(glm::length(sample.direction), 1.0, 1e-12);
        observed[binOf(sample.direction)] += 1.0;
        integral.add(map.radiance(sample.direction).x / sample.density);
        const dvec3 anywhere = turned({0.0, 1.0, 0.0}, 2.0 * random.uniform(), random);
        expected[binOf(anywhere)] += map.density(anywhere) * 4.0 * pi;
        plain.add(map.radiance(anywhere).x * 4.0 * pi);
        EXPECT_TRUE(map.radiance(anywhere).x == 0.0 || map.density(anywhere) > 0.0);
    }
    for (std::size_t i = 0; i < observed.size(); ++i) {
        // of both counts, the expected ones with weights up to 12
        EXPECT_NEAR(observed[i], expected[i], 5.0 * std::sqrt(13.0 * expected[i] + 1.0)) << i;
    }
    EXPECT_NEAR(integral.mean(), plain.mean(), 4.0 * std::hypot(integral.standardError(), plain.standardError()));
    EXPECT_LT(integral.standardError(), 0.01 * integral.mean());
}

/// A white ground that faces the map has its irradiance over π, with the sun in the map or taken out of it.
TEST_F(ReferenceMap, IrradianceIsTheMapsIntegral) {
    constexpr int width = 512;
    scene::Scene scene = sceneOf(width, withSpot);
    scene.ground = scene::Ground{dvec3(1.0), 0.0};
    dvec3 irradiance(0.0);
    for (int y = 0; y < width / 4; ++y)
        for (int x = 0; x < width; ++x) {
            const dvec3 d = test::mapDirection(x, y, width);
            const double angle =
                2.0 * pi / width * (std::cos(2.0 * pi * y / width) - std::cos(2.0 * pi * (y + 1) / width));
            irradiance += withSpot(d) * d.y * angle;
        }
    for (const bool takenOut : {false, true}) {
        scene.sky.mapSun = takenOut;
        const PathTracer tracer(scene, {}, Majorant::local);
        Random random(62, 0, 0);
        RunningMean mean[3];
        for (int i = 0; i < 40'000; ++i) {
            const PathSample sample = tracer.trace({{0.0, 5.0, 0.0}, {0.0, -1.0, 0.0}}, random);
            for (int c = 0; c < 3; ++c) mean[c].add(sample.radiance[c]);
        }
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean[c].mean(), irradiance[c] / pi, 4.0 * mean[c].standardError() + 2e-3 * irradiance[c] / pi);
            EXPECT_LT(mean[c].standardError(), 0.01 * mean[c].mean());
        }
        EXPECT_EQ(tracer.environment().sunny(), takenOut);
    }
}

TEST_F(ReferenceMap, FindsTheSun) {
    scene::Scene scene = sceneOf(1024, withSpot);
    scene.sky.mapRotation = 30.0;
    const SkyMap map(scene.sky);
    ASSERT_TRUE(map.sun());
    EXPECT_LT(glm::distance(map.sun()->directionTo, scene::skyDirection(70.0, 50.0)), glm::radians(0.1));
    EXPECT_NEAR(map.sun()->angularDiameter, 2.4, 0.1);
    const double sine = std::sin(glm::radians(1.2));
    EXPECT_NEAR(map.sun()->irradiance.y, 8000.0 * pi * sine * sine, 0.05 * 8000.0 * pi * sine * sine);
    EXPECT_LT(map.radiance(map.sun()->directionTo).x, 0.3) << "the sky goes on behind it";
    EXPECT_FALSE(SkyMap(skyOf(painted(64, smooth))).sun()) << "a bright side is no sun";
}

/// Light by aiming and by chance adds up to that by chance alone: a cloud under a map, against the mean of its escapes.
TEST_F(ReferenceMap, LightsCloudsLikeEscapesAlone) {
    scene::Scene scene = sceneOf(64, [](const dvec3& d) {
        return smooth(d) + (glm::dot(d, scene::skyDirection(180.0, 10.0)) > 0.97 ? dvec3(30.0) : dvec3(0.0));
    });
    scene.sky.mapSun = false;
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.2;
    scene.clouds[0].phase.g = 0.7;
    const vdb::Volume ball = ballVolume(16, 10.0);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    const Clouds clouds(scene.clouds, {ball}, Majorant::local);
    const SkyMap map(scene.sky);
    Random random(63, 0, 0);
    const Ray start{{3.0, 0.0, 50.0}, {0.0, 0.0, -1.0}};
    RunningMean aimed, chance;
    for (int i = 0; i < 60'000; ++i) {
        const PathSample sample = tracer.trace(start, random);
        aimed.add(sample.radiance.x + sample.passed.x);
    }
    for (int i = 0; i < 150'000; ++i) {
        Ray ray = start;
        while (const auto collision = clouds.collide(clouds.raysOf(ray), 1e300, random)) {
            ray.origin += collision->metres * ray.direction;
            ray.direction = turned(ray.direction, clouds.phase(0).sample(random), random);
        }
        chance.add(map.radiance(ray.direction).x);
    }
    EXPECT_NEAR(aimed.mean(), chance.mean(), 4.0 * std::hypot(aimed.standardError(), chance.standardError()));
    EXPECT_LT(aimed.standardError(), 0.02 * aimed.mean());
}

TEST_F(ReferenceMap, BadMapsAreNamed) {
    expectBadMapsAreNamed();
}

}  // namespace
}  // namespace lumulus::reference
