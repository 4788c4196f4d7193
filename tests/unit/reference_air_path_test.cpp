#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "reference/air.h"
#include "reference/air_path.h"
#include "reference/ground.h"
#include "reference/surfaces.h"

// Optical depths of the air against closed forms, published values and sums of small steps.
namespace lumulus::reference {
namespace {

using glm::dvec3;

constexpr double endless = std::numeric_limits<double>::infinity();

Ray rayAt(double height, double elevation) {
    const double e = glm::radians(elevation);
    return {{0.0, height, 0.0}, {std::cos(e), std::sin(e), 0.0}};
}

/// The same integral by small steps along the ray, from the places in the world alone.
AirParts bySteps(const Ray& ray, double ground, double begin, double end, int steps) {
    AirParts sum;
    const dvec3 middle(0.0, ground - planetRadius, 0.0);
    for (int i = 0; i < steps; ++i) {
        const double t = begin + (end - begin) * (i + 0.5) / steps;
        sum +=
            airPartsAt(glm::distance(ray.origin + t * ray.direction, middle) - planetRadius) * ((end - begin) / steps);
    }
    return sum;
}

void expectNear(const AirParts& found, const AirParts& expected, double relative) {
    EXPECT_NEAR(found.molecules, expected.molecules, relative * expected.molecules);
    EXPECT_NEAR(found.aerosol, expected.aerosol, relative * expected.aerosol + 1e-3);
    EXPECT_NEAR(found.ozone, expected.ozone, relative * expected.ozone + 1e-3);
}

TEST(ReferenceAirPath, UpwardColumnsAreClosedForms) {
    const AirParts column = AirPath(rayAt(0.0, 90.0), 0.0, endless).whole();
    expectNear(column, {8e3 * -std::expm1(-12.5), 1.2e3 * -std::expm1(-100.0 / 1.2), 15e3}, 1e-6);
    const AirParts above = AirPath(rayAt(20e3, 90.0), 0.0, endless).whole();
    EXPECT_NEAR(above.ozone, 15e3 - 0.5 * 10e3 * (10.0 / 15.0), 1e-3);
    const AirParts shifted = AirPath(rayAt(4020e3, 90.0), 4000e3, endless).whole();
    expectNear(shifted, above, 1e-9);
}

/// Hillaire's medium has a known transmittance to the zenith; the others are values of another program.
TEST(ReferenceAirPath, HillairesTransmittances) {
    scene::Sky sky;
    sky.hillaire = true;
    const AirMedium medium = AirMedium::of(sky);
    const Air air(medium, 0.0);
    const auto expectRgb = [&](double elevation, const dvec3& expected, double tolerance) {
        const Four t = air.transmittance(rayAt(0.0, elevation), endless);
        EXPECT_NEAR(t.z, expected.x, tolerance) << elevation;
        EXPECT_NEAR(t.y, expected.y, tolerance) << elevation;
        EXPECT_NEAR(t.x, expected.z, tolerance) << elevation;
    };
    expectRgb(90.0, {0.94036, 0.86762, 0.76231}, 1e-5);
    expectRgb(10.0, {0.71294, 0.45938, 0.22163}, 2e-5);
    expectRgb(2.0, {0.33081, 0.08528, 0.00616}, 2e-5);
    expectRgb(0.0, {0.10643, 0.00958, 5.2e-5}, 2e-5);
}

/// Air masses of Kasten and Young 1989, to which a shell of 8 km comes near.
TEST(ReferenceAirPath, MoleculesHaveTheirAirMass) {
    const double zenith = AirPath(rayAt(0.0, 90.0), 0.0, endless).whole().molecules;
    const auto mass = [&](double elevation) {
        return AirPath(rayAt(0.0, elevation), 0.0, endless).whole().molecules / zenith;
    };
    EXPECT_NEAR(mass(30.0), 1.994, 0.002);
    EXPECT_NEAR(mass(10.0), 5.586, 0.04);
    EXPECT_NEAR(mass(5.0), 10.31, 0.2);
    EXPECT_NEAR(mass(0.0), 35.4, 0.05);
}

TEST(ReferenceAirPath, AgreesWithSmallSteps) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < 40; ++i) {
        const double ground = 500.0 * uniform(random), height = 99e3 * std::pow(uniform(random), 3.0);
        const Ray ray = rayAt(ground + height, 180.0 * std::pow(uniform(random), 3.0));
        const double length = 400e3 * std::pow(uniform(random), 2.0);
        expectNear(AirPath(ray, ground, length).whole(), bySteps(ray, ground, 0.0, length, 400'000), 2e-6);
    }
    // from space past the ground and out again
    Ray past{{-3000e3, 20e3, 0.0}, {1.0, 0.0, 0.0}};
    expectNear(AirPath(past, 0.0, endless).whole(), bySteps(past, 0.0, 0.0, 6000e3, 2'000'000), 2e-6);
    // down to the ground, 10 km below and 60 km away at least
    const Ray down = rayAt(10e3, -9.0);
    const std::vector<scene::Surface> planet = [] {
        scene::Scene scene;
        scene.sky.model = scene::SkyModel::atmosphere;
        return surfacesOf(scene);
    }();
    const double toGround = Surfaces(planet).nearest(down, Surfaces::none)->metres;
    expectNear(AirPath(down, 0.0, endless).whole(), bySteps(down, 0.0, 0.0, toGround, 400'000), 2e-6);
    EXPECT_TRUE(AirPath(rayAt(120e3, 10.0), 0.0, endless).empty());
}

TEST(ReferenceAirPath, ReachesTheDepthThatWasAsked) {
    const dvec3 extinction(1.5e-5, 6.7e-5, 1.1e-6);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto depthOf = [&](const AirParts& parts) {
        return parts.molecules * extinction.x + parts.aerosol * extinction.y + parts.ozone * extinction.z;
    };
    int reached = 0;
    for (int i = 0; i < 200; ++i) {
        const Ray ray = rayAt(50e3 * std::pow(uniform(random), 3.0), -20.0 + 60.0 * uniform(random));
        const AirPath path(ray, 0.0, endless);
        const double wanted = 2.0 * uniform(random);
        const AirPath::Place place = path.reach(wanted, extinction);
        ASSERT_EQ(place.reached, wanted < depthOf(path.whole()));
        EXPECT_NEAR(depthOf(place.parts), place.reached ? wanted : depthOf(path.whole()), 1e-8);
        if (!place.reached) continue;
        ++reached;
        EXPECT_NEAR(depthOf(AirPath(ray, 0.0, place.metres).whole()), wanted, 1e-6);
        const double height = glm::distance(ray.origin + place.metres * ray.direction, {0.0, -planetRadius, 0.0});
        EXPECT_NEAR(place.height, height - planetRadius, 1e-5);
    }
    EXPECT_GT(reached, 30);
}

/// METHODS' table of coefficients, and the sun's illuminance above the air: 132.1 klx.
TEST(ReferenceAirMedium, HasThePublishedCoefficients) {
    const AirMedium air = AirMedium::of(scene::Sky{});
    const Four molecules(0.03033, 0.01526, 0.01127, 0.00655), aerosol(0.08098, 0.06694, 0.06152, 0.05283);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(1e3 * air.molecules[i], molecules[i], 1e-5);
        EXPECT_NEAR(1e3 * air.aerosol[i], aerosol[i], 1e-5);
        EXPECT_NEAR(air.aerosolScattering[i] / air.aerosol[i], 0.92, 1e-12);
    }
    const dvec3 sun = air.toRgb * Four(1.0);
    EXPECT_NEAR(683.0 * glm::dot(sun, {0.2126, 0.7152, 0.0722}), 132.1e3, 50.0);
    for (const bool hillaire : {false, true}) {
        scene::Sky sky;
        sky.hillaire = hillaire;
        const AirMedium medium = AirMedium::of(sky);
        const dvec3 back = medium.toRgb * medium.lightOf({0.3, 2.0, 5.0});
        EXPECT_NEAR(glm::distance(back, {0.3, 2.0, 5.0}), 0.0, 1e-12);
        EXPECT_EQ(medium.spread({0.1, 0.2, 0.3}).x, 0.3) << "blue counts at 440 nm";
        EXPECT_NEAR(medium.spread({0.1, 0.2, 0.3}).z, medium.fromRgb[0].z == 1.0 ? 0.1 : 0.175, 1e-15);
        EXPECT_EQ(medium.spread({0.1, 0.2, 0.3}).w, 0.1) << "red counts at the longest";
    }
}

}  // namespace
}  // namespace lumulus::reference
