// The atmosphere against published values (METHODS-sky-clouds-motion.md, "Known answers") and against closed forms.
#include "sky/atmosphere.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "sky/shell.h"
#include "sky/sun_reach.h"

namespace lumulus::sky {
namespace {

using glm::dvec3;
using std::numbers::pi;

const Atmosphere& standard() {
    static const Atmosphere made{scene::Sky{}};
    return made;
}

const Atmosphere& ofHillaire() {
    static const Atmosphere made = [] {
        scene::Sky sky;
        sky.hillaire = true;
        return Atmosphere(sky);
    }();
    return made;
}

double sine(double degrees) {
    return std::sin(glm::radians(degrees));
}

dvec3 sunAt(double elevation) {
    return scene::skyDirection(0.0, elevation);
}

const dvec3 eye(0.0, 2.0, 0.0);

double zenith(double elevation) {
    return photometric(standard().radiance(eye, {0.0, 1.0, 0.0}, sunAt(elevation)));
}

double skyLux(double elevation) {
    return photometric(standard().skyIrradiance(eye, sunAt(elevation)));
}

double sunLux(double elevation) {
    return photometric(standard().sunIrradiance(eye, sunAt(elevation)));
}

/// CIE 1931 x, y of linear Rec. 709.
glm::dvec2 chromaticity(const dvec3& c) {
    const double x = 0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b, y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    const double z = 0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b;
    return glm::dvec2(x, y) / (x + y + z);
}

TEST(Air, CoefficientsAreThoseOfTheMethods) {
    const Air& air = standard().air();
    const Spectrum molecules(0.03033, 0.01526, 0.01127, 0.00655), aerosol(0.08098, 0.06694, 0.06152, 0.05283);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(1e3 * air.molecules[i], molecules[i], 0.6e-5) << i;
        EXPECT_NEAR(1e3 * air.aerosolExtinction[i], aerosol[i], 0.6e-5) << i;
    }
}

TEST(Air, PhaseFunctionsHoldAllLight) {
    double molecules = 0.0, aerosol = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const double c = -1.0 + (i + 0.5) / 10000.0;
        molecules += 2.0 * pi * moleculePhase(c) / 10000.0;
        aerosol += 2.0 * pi * standard().air().aerosolPhase(c) / 10000.0;
    }
    EXPECT_NEAR(molecules, 1.0, 1e-6);
    EXPECT_NEAR(aerosol, 1.0, 1e-6);
}

/// Vertical optical depths of ASTM G173's direct sun per air mass.
TEST(OpticalDepth, IsThatOfTheStandardAtmosphere) {
    const std::array<std::array<double, 2>, 3> published{{{440.0, 0.3395}, {550.0, 0.2080}, {680.0, 0.1110}}};
    const std::array<double, 3> ozone{0.000085e-3, 0.002251e-3, 0.00065e-3};
    const dvec3 columns = standard().columns().toTop(0.0, 1.0);
    for (std::size_t i = 0; i < published.size(); ++i) {
        const double wavelength = published[i][0];
        const double depth = moleculeDepth(wavelength) / 8000.0 * columns.x +
                             0.084 / 1200.0 * std::pow(wavelength / 500.0, -1.14) * columns.y + ozone[i] * columns.z;
        EXPECT_NEAR(depth, published[i][1], 0.04 * published[i][1]) << wavelength;
    }
}

TEST(OpticalDepth, OfTheZenithIsTheClosedForm) {
    const Air& air = ofHillaire().air();
    const dvec3 columns = ofHillaire().columns().toTop(0.0, 1.0);
    EXPECT_NEAR(columns.x, 8000.0 * (1.0 - std::exp(-12.5)), 0.1);
    EXPECT_NEAR(columns.y, 1200.0, 0.1);
    EXPECT_NEAR(columns.z, 15000.0, 15.0);
    const Spectrum passed = glm::exp(-opticalDepth(air, columns));
    EXPECT_NEAR(passed[2], 0.94036, 2e-5);
    EXPECT_NEAR(passed[1], 0.86762, 2e-5);
    EXPECT_NEAR(passed[0], 0.76231, 2e-5);
}

TEST(OpticalDepth, ReachesTheHorizon) {
    struct Row {
        double elevation, red, green, blue;
    };
    const Air& air = ofHillaire().air();
    for (const Row& row : {Row{10.0, 0.71294, 0.45938, 0.22163}, Row{2.0, 0.33081, 0.08528, 0.00616},
                           Row{0.0, 0.10643, 0.00958, 5.2e-5}}) {
        const Spectrum depth = opticalDepth(air, ofHillaire().columns().toTop(0.0, sine(row.elevation)));
        EXPECT_NEAR(depth[2], -std::log(row.red), 1e-3);
        EXPECT_NEAR(depth[1], -std::log(row.green), 1e-3);
        EXPECT_NEAR(depth[0], -std::log(row.blue), 5e-3);
    }
}

/// The table between its texels, from the ground to 80 km and down to the horizon, within 0.05 of optical depth.
TEST(OpticalDepth, InterpolatesWell) {
    for (const double height : {0.0, 2.0, 37.0, 300.0, 1500.0, 9000.0, 33000.0, 80000.0}) {
        const double horizon = std::asin(horizonCosine(height));
        for (int i = 0; i < 60; ++i) {
            const double up = std::sin(horizon + (0.5 * pi - horizon) * std::pow(i / 59.0, 3));
            const Spectrum exact = opticalDepth(ofHillaire().air(), ColumnTable::integrate(height, up));
            const Spectrum found = opticalDepth(ofHillaire().air(), ofHillaire().columns().toTop(height, up));
            EXPECT_NEAR(found[1], exact[1], 0.05) << height << " " << up;
        }
    }
}

/// Kasten and Young 1989; below 10° scale heights differ.
TEST(OpticalDepth, AirMassesOfMolecules) {
    const auto airMass = [](double elevation) {
        return standard().columns().toTop(0.0, sine(elevation)).x / standard().columns().toTop(0.0, 1.0).x;
    };
    EXPECT_NEAR(airMass(30.0), 1.994, 0.01 * 1.994);
    EXPECT_NEAR(airMass(10.0), 5.586, 0.01 * 5.586);
    EXPECT_NEAR(airMass(5.0), 10.31, 0.02 * 10.31);
    EXPECT_NEAR(airMass(0.0), 37.9, 0.08 * 37.9);
}

/// ASTM G173 at air mass 1.5: 97.1 klx, x y 0.339 0.350.
TEST(Atmosphere, DirectSunOfTheStandard) {
    EXPECT_NEAR(sunLux(41.81), 97.1e3, 0.04 * 97.1e3);
    const glm::dvec2 xy = chromaticity(standard().sunIrradiance(eye, sunAt(41.81)));
    EXPECT_NEAR(xy.x, 0.339, 0.004);
    EXPECT_NEAR(xy.y, 0.350, 0.004);
    EXPECT_NEAR(photometric(standard().sunAbove()), 132.1e3, 100.0);
}

TEST(Atmosphere, LowSunsAreRed) {
    const std::array<std::array<double, 3>, 4> table{
        {{20.0, 0.358, 0.366}, {10.0, 0.391, 0.391}, {5.0, 0.446, 0.418}, {2.0, 0.531, 0.422}}};
    for (const auto& row : table) {
        const glm::dvec2 xy = chromaticity(standard().sunIrradiance(eye, sunAt(row[0])));
        EXPECT_NEAR(xy.x, row[1], 0.006) << row[0];
        EXPECT_NEAR(xy.y, row[2], 0.006) << row[0];
    }
}

/// Karayel 1984, turbidity 2.75.
TEST(Atmosphere, LuminanceOfTheZenith) {
    const std::array<std::array<double, 2>, 6> published{
        {{60.0, 3799.0}, {45.0, 2354.0}, {30.0, 1520.0}, {20.0, 1098.0}, {10.0, 728.0}, {5.0, 553.0}}};
    for (const auto& row : published) EXPECT_NEAR(zenith(row[0]), row[1], 0.15 * row[1]) << row[0];
}

/// Hošek and Wilkie 2012, turbidity 2 to 2.5: zenith [cd/m²] and level illuminance of the sky [klx]. At 30° and 10°
/// their zenith is a third to a half brighter than Karayel's, so that they bound from above what lies near Karayel's.
TEST(Atmosphere, SkyBesideThatOfHosek) {
    struct Row {
        double elevation, zenithFrom, zenithTo, luxFrom, luxTo, most;
    };
    for (const Row& row : {Row{60, 3119, 3507, 15.2e3, 16.5e3, 0.15}, Row{30, 1995, 2074, 13.1e3, 14.1e3, 0.35},
                           Row{10, 1139, 1163, 8.5e3, 8.9e3, 0.35}}) {
        EXPECT_GT(zenith(row.elevation), (1.0 - row.most) * row.zenithFrom) << row.elevation;
        EXPECT_LT(zenith(row.elevation), 1.15 * row.zenithTo) << row.elevation;
        EXPECT_GT(skyLux(row.elevation), (1.0 - 0.25) * row.luxFrom) << row.elevation;
        EXPECT_LT(skyLux(row.elevation), 1.05 * row.luxTo) << row.elevation;
    }
}

/// Explanatory Supplement to the Astronomical Almanac: sun and sky on level ground.
TEST(Atmosphere, IlluminanceOfTheGround) {
    const std::array<std::array<double, 2>, 6> day{
        {{60.0, 103e3}, {30.0, 46.3e3}, {10.0, 11.1e3}, {5.0, 4540.0}, {2.0, 1920.0}, {0.0, 759.0}}};
    for (const auto& row : day)
        EXPECT_NEAR((sunLux(row[0]) * sine(row[0]) + skyLux(row[0])) / row[1], 1.0, 0.35) << row[0];
    const std::array<std::array<double, 2>, 5> twilight{
        {{-2.0, 189.0}, {-4.0, 29.9}, {-6.0, 3.41}, {-9.0, 0.116}, {-12.0, 0.0081}}};
    for (const auto& row : twilight) {
        EXPECT_LT(skyLux(row[0]), (row[0] < -8.0 ? 2.8 : 2.3) * row[1]) << row[0];
        EXPECT_GT(skyLux(row[0]), row[1] / 2.3) << row[0];
    }
}

/// Hošek's sky of turbidity 2 to 2.5, in klx, and the share of sky against sun that METHODS found.
TEST(Atmosphere, IlluminanceOfTheSky) {
    EXPECT_NEAR(skyLux(60.0), 15.2e3, 0.08 * 15.2e3);
    EXPECT_NEAR(skyLux(30.0), 11.6e3, 0.03 * 11.6e3);
    EXPECT_NEAR(skyLux(10.0), 6.6e3, 0.03 * 6.6e3);
    EXPECT_NEAR(skyLux(60.0) / (sunLux(60.0) * sine(60.0)), 0.157, 0.04 * 0.157);
    EXPECT_NEAR(skyLux(30.0) / (sunLux(30.0) * sine(30.0)), 0.260, 0.03 * 0.260);
    EXPECT_NEAR(skyLux(10.0) / (sunLux(10.0) * sine(10.0)), 0.853, 0.03 * 0.853);
    EXPECT_NEAR(skyLux(5.0) / (sunLux(5.0) * sine(5.0)), 2.55, 0.03 * 2.55);
}

/// What is given in RGB counts at 560 nm by three quarters of G and a quarter of R.
TEST(Air, GroundIsThreeQuartersGreenAt560) {
    scene::Sky sky;
    sky.groundAlbedo = {0.1, 0.2, 0.3};
    const Spectrum albedo = airOf(sky).groundAlbedo;
    EXPECT_NEAR(albedo[0], 0.3, 1e-12);
    EXPECT_NEAR(albedo[1], 0.2, 1e-12);
    EXPECT_NEAR(albedo[2], 0.175, 1e-12);
    EXPECT_NEAR(albedo[3], 0.1, 1e-12);
}

/// METHODS, section 2: transmittance to the sun at 550 nm; here between those at 520 and 560 nm.
TEST(Atmosphere, SunAtHeights) {
    struct Row {
        double elevation, height, passed;
    };
    for (const Row& row : {Row{30, 1e3, 0.75}, Row{30, 8e3, 0.88}, Row{10, 4e3, 0.61}, Row{2, 1e3, 0.065}}) {
        const Spectrum passed = standard().sunTransmittance(row.height, sine(row.elevation));
        EXPECT_NEAR(0.25 * passed[1] + 0.75 * passed[2], row.passed, 0.012) << row.elevation << " " << row.height;
    }
}

}  // namespace
}  // namespace lumulus::sky
