// A picture of the surroundings as the sky: directions, sums, its sun, and what is refused.
#include "sky/map_sky.h"

#include <gtest/gtest.h>

#include "reference/sky_map.h"
#include "support/painted_map.h"

namespace lumulus::sky {
namespace {

using glm::dvec3;
using std::numbers::pi;
using test::painted;
using test::smooth;
using test::withSpot;

using MapSkyTest = test::PaintedMapTest<MapSky>;

TEST_F(MapSkyTest, LooksWhereThePictureSays) {
    scene::Sky sky = skyOf(painted(256, smooth));
    sky.mapSun = false;
    sky.mapScale = 3.0;
    for (const double rotation : {0.0, 90.0, -200.0}) {
        sky.mapRotation = rotation;
        const MapSky map(sky);
        const reference::SkyMap other(sky);
        for (const double azimuth : {-170.0, 0.0, 33.0, 179.9})
            for (const double elevation : {-90.0, -20.0, 0.0, 70.0}) {
                const dvec3 direction = scene::skyDirection(azimuth + rotation, elevation);
                const dvec3 found = map.radiance(direction);
                EXPECT_LT(glm::distance(found, 3.0 * smooth(scene::skyDirection(azimuth, elevation))), 0.03);
                EXPECT_LT(glm::distance(found, other.radiance(direction)), 1e-5) << azimuth << " " << elevation;
            }
    }
}

/// ∫ (1 + a·x) = 4π, and ∫ max(0, n·x) (c + a·x) = π c + 2π/3 a·n.
TEST_F(MapSkyTest, SumsAreThoseOfTheRadiance) {
    const MapSky map(skyOf(painted(128, smooth)));
    EXPECT_LT(glm::distance(map.mean(), dvec3(1.0, 1.0, 2.0)), 1e-3);
    const dvec3 up = map.irradiance({0.0, 1.0, 0.0}), east = map.irradiance({1.0, 0.0, 0.0});
    EXPECT_LT(glm::distance(up, pi * dvec3(1.0, 1.0, 2.0) + 2.0 * pi / 3.0 * dvec3(0.0, 0.0, 1.0)), 5e-3);
    EXPECT_LT(glm::distance(east, pi * dvec3(1.0, 1.0, 2.0) + 2.0 * pi / 3.0 * dvec3(0.8, 0.0, 0.0)), 5e-3);
}

dvec3 sumOf(const LatLong& map) {
    dvec3 sum(0.0);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) sum += dvec3(map.at(x, y)) * map.solidAngle(y);
    return sum;
}

/// No size of the map, and no number of cells, changes what a part of the sky sends.
TEST_F(MapSkyTest, IrradianceDoesNotDependOnTheResolution) {
    scene::Sky sky = skyOf(painted(512, withSpot));
    sky.mapSun = false;
    const MapSky map(sky);
    const dvec3 whole = sumOf(map.pixels());
    for (const int width : {340, 256, 64, 20})
        EXPECT_LT(glm::distance(sumOf(reduced(map.pixels(), width)), whole), 1e-4 * glm::length(whole)) << width;
    for (const int width : {64, 128, 700})
        EXPECT_LT(glm::distance(sumOf(MapSky(skyOf(painted(width, smooth))).cells(512)), 4.0 * pi * dvec3(1, 1, 2)),
                  0.02)
            << width;
}

TEST_F(MapSkyTest, ItsSunIsThatOfTheReference) {
    scene::Sky sky = skyOf(painted(1024, withSpot));
    sky.mapRotation = 30.0;
    const MapSky map(sky);
    const reference::SkyMap other(sky);
    ASSERT_TRUE(map.sun() && other.sun());
    EXPECT_LT(glm::distance(map.sun()->directionTo, scene::skyDirection(70.0, 50.0)), glm::radians(0.1));
    EXPECT_LT(glm::distance(map.sun()->directionTo, other.sun()->directionTo), 1e-6);
    EXPECT_NEAR(map.sun()->angularDiameter, other.sun()->angularDiameter, 1e-6);
    EXPECT_LT(glm::distance(map.sun()->irradiance, other.sun()->irradiance), 1e-5 * other.sun()->irradiance.x);
    EXPECT_LT(map.radiance(map.sun()->directionTo).x, 0.3) << "the sky goes on behind it";
    EXPECT_FALSE(MapSky(skyOf(painted(64, smooth))).sun()) << "a bright side is no sun";
    sky.mapSun = false;
    EXPECT_FALSE(MapSky(sky).sun());
}

TEST_F(MapSkyTest, BadMapsAreNamed) {
    expectBadMapsAreNamed();
}

}  // namespace
}  // namespace lumulus::sky
