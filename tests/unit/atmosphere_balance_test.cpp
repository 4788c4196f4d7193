// The atmosphere as a whole: light is neither made nor lost, and no place from the ground to orbit breaks a formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sky/atmosphere.h"
#include "sky/shell.h"
#include "sky/sun_reach.h"

namespace lumulus::sky {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// Light that leaves a planet by all ways, against the light that meets its air: the sky's out of its top, the sun's
/// that passed beside the ground, and what the ground absorbs.
Spectrum fluxBalance(const Atmosphere& planet) {
    constexpr int suns = 80, cosines = 40, azimuths = 16;
    const double top = planetRadius + airTop;
    Spectrum out(0.0);
    for (int k = 0; k < suns; ++k) {
        const double sun = -0.28 + 1.28 * (k + 0.5) / suns, area = 2.0 * pi * 1.28 / suns;
        Spectrum leaving(0.0);
        for (int j = 0; j < cosines; ++j) {
            const double root = (j + 0.5) / cosines, up = root * root;  // denser along the limb
            for (int i = 0; i < azimuths; ++i) {
                const double across = std::sqrt(1.0 - sun * sun) * std::sqrt(1.0 - up * up);
                const double toSun = -up * sun + across * std::cos(pi * (i + 0.5) / azimuths);
                const AirPoint from{airTop, -up, sun, toSun};
                leaving +=
                    planet.sky(from).light(planet.air(), toSun) * (up * 2.0 * root / cosines * 2.0 * pi / azimuths);
            }
        }
        const Spectrum falling =
            planet.multipleScattering().groundIrradiance(sun) + std::max(0.0, sun) * planet.sunTransmittance(0.0, sun);
        out += area * (top * top * leaving + planetRadius * planetRadius * (1.0 - planet.air().groundAlbedo) * falling);
    }
    constexpr int rings = 400;
    for (int i = 0; i < rings; ++i) {
        const double height = airTop * std::pow((i + 0.5) / rings, 2), width = 2.0 * airTop * (i + 0.5) / rings / rings;
        out += glm::exp(-2.0 * opticalDepth(planet.air(), planet.columns().toTop(height, 0.0))) *
               (2.0 * pi * (planetRadius + height) * width);
    }
    return out / (pi * top * top);
}

Air conservative(double groundAlbedo, double aerosol) {
    scene::Sky sky;
    sky.hillaire = true;
    Air air = airOf(sky);
    air.ozone = Spectrum(0.0);
    air.aerosolExtinction = air.aerosolScattering = Spectrum(aerosol);
    air.groundAlbedo = Spectrum(groundAlbedo);
    return air;
}

TEST(AtmosphereBalance, MoleculesConserveLight) {
    for (const double albedo : {0.0, 0.3, 1.0}) {
        const Spectrum balance = fluxBalance(Atmosphere(conservative(albedo, 0.0), 0.0, 0.53));
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(balance[i], 1.0, 0.006) << albedo << " " << i;
    }
}

TEST(AtmosphereBalance, AerosolConservesLight) {
    const Spectrum balance = fluxBalance(Atmosphere(conservative(0.3, 7e-5), 0.0, 0.53));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(balance[i], 1.0, 0.006) << i;
}

/// Where the ground gives back next to nothing the harmonics of the light from below swing under 0. No number breaks,
/// and the sky darkens step by step with the ground.
TEST(AtmosphereBalance, BlackGroundHasASky) {
    const auto illuminance = [](double albedo, double elevation) {
        scene::Sky sky;
        sky.groundAlbedo = dvec3(albedo);
        return photometric(Atmosphere(sky).skyIrradiance({0.0, 2.0, 0.0}, scene::skyDirection(0.0, elevation)));
    };
    for (const double elevation : {-4.0, 0.0, 30.0}) {
        const double black = illuminance(0.0, elevation), dark = illuminance(0.001, elevation),
                     grey = illuminance(0.2, elevation);
        EXPECT_GT(black, 0.85 * grey) << elevation;
        EXPECT_LT(black, dark) << elevation;
        EXPECT_LT(dark, black + 0.02 * (grey - black)) << elevation;
    }
}

/// Forms in single precision against double precision: heights, and distances of the ground from 1.5 m to orbit.
TEST(AtmosphereShell, FormsKeepTheirDigits) {
    for (const double height : {1.5, 100.0, 1e4, 4e5, 2e7, 4e7})
        for (const double below : {1e-3, 0.1, 0.7}) {
            const double up = std::max(-1.0, horizonCosine(height) - below);
            const auto r = static_cast<float>(planetRadius), h = static_cast<float>(height), u = static_cast<float>(up);
            const float b = (r + h) * u, c = h * (2.0F * r + h);
            const float ground = c / (-b + std::sqrt(b * b - c));
            const double exact = distanceToGround(height, static_cast<double>(u));
            EXPECT_NEAR(static_cast<double>(ground), exact, 1e-4 * exact) << height << " " << below;
            EXPECT_NEAR(heightAlong(height, static_cast<double>(u), exact), 0.0, 1e-6 * height + 1e-6);
        }
}

TEST(AtmosphereShell, SunSetsWithItsDisc) {
    double middle = 0.0;
    const double radius = glm::radians(0.265);
    EXPECT_NEAR(visibleShare(0.0, 0.0, radius, middle), 0.5, 1e-9);
    EXPECT_NEAR(std::asin(middle), 0.5 * radius, 1e-9);
    EXPECT_EQ(visibleShare(0.0, std::sin(1.01 * radius), radius, middle), 1.0);
    EXPECT_EQ(visibleShare(0.0, -std::sin(1.01 * radius), radius, middle), 0.0);
    EXPECT_EQ(visibleShare(10000.0, -std::sin(glm::radians(2.9)), radius, middle), 1.0);  // the dip is 3.2° there
}

/// Sky, sun and air from 0 to 40,000 km are finite and not negative; space beside the planet is dark.
TEST(AtmosphereShell, NothingBreaksFromTheGroundToOrbit) {
    const Atmosphere planet{scene::Sky{}};
    for (const double height : {0.0, 2.0, 1e3, 99999.0, 1e5, 1.00001e5, 4e5, 4e7})
        for (const double elevation : {-90.0, -30.0, -8.0, -2.0, -0.1, 0.0, 0.1, 5.0, 90.0})
            for (const double sun : {-90.0, -10.0, 0.0, 20.0, 90.0}) {
                const dvec3 eye(0.0, height, 0.0), toSun = scene::skyDirection(10.0, sun);
                const dvec3 seen = planet.radiance(eye, scene::skyDirection(0.0, elevation), toSun);
                const dvec3 light = planet.sunIrradiance(eye, toSun);
                for (int c = 0; c < 3; ++c) {
                    ASSERT_TRUE(std::isfinite(seen[c]) && seen[c] >= 0.0) << height << " " << elevation << " " << sun;
                    ASSERT_TRUE(std::isfinite(light[c]) && light[c] >= 0.0) << height << " " << sun;
                }
            }
    EXPECT_EQ(planet.radiance({0.0, 4e7, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), dvec3(0.0));
    EXPECT_EQ(planet.sunColour({0.0, 4e7, 0.0}, {1.0, 0.0, 0.0}), dvec3(1.0));
}

/// A path in two parts is the path: transmittances multiply, light adds up.
TEST(AtmosphereShell, PathsAddUp) {
    const Atmosphere planet{scene::Sky{}};
    const AirPoint from = planet.at({0.0, 500.0, 0.0}, scene::skyDirection(30.0, 2.0), scene::skyDirection(0.0, 30.0));
    const AirLight whole = planet.along(from, 60e3, 200), first = planet.along(from, 20e3, 200);
    const AirLight second = planet.along(from.after(20e3), 40e3, 200);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(whole.transmittance[i], first.transmittance[i] * second.transmittance[i], 1e-4);
        EXPECT_NEAR(whole.scattered[i], first.scattered[i] + first.transmittance[i] * second.scattered[i],
                    2e-3 * whole.scattered[i]);
    }
}

}  // namespace
}  // namespace lumulus::sky
