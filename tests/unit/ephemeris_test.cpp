// Sun and moon against published examples and against eclipses, which everybody saw.
#include "scene/ephemeris.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/sky.h"

namespace lumulus::scene {
namespace {

Utc at(const char* text) {
    const auto utc = parseUtc(text);
    EXPECT_TRUE(utc.has_value()) << text;
    return utc.value_or(Utc{});
}

double centuriesOf(double julianDay) {
    return (julianDay - 2451545.0) / 36525.0;
}

TEST(Utc, JulianDaysOfMeeus) {
    EXPECT_NEAR((Utc{1957, 10, 4, 0.81 * 24.0}.julianDay()), 2436116.31, 1e-6);
    EXPECT_NEAR((Utc{2000, 1, 1, 12.0}.julianDay()), 2451545.0, 1e-9);
    EXPECT_NEAR((Utc{1987, 6, 19, 12.0}.julianDay()), 2446966.0, 1e-9);
}

TEST(Utc, IsReadStrictly) {
    EXPECT_NEAR(at("2026-06-21T10:30:36.5Z").hours, 10.0 + 30.0 / 60.0 + 36.5 / 3600.0, 1e-9);
    EXPECT_NEAR(at("2024-02-29T23:59Z").hours, 23.0 + 59.0 / 60.0, 1e-9);
    for (const char* wrong : {"", "2026-06-21", "2026-06-21T10:00:00", "2026-06-21 10:00:00Z", "2026-13-21T10:00:00Z",
                              "2025-02-29T10:00:00Z", "2026-06-31T10:00:00Z", "2026-06-21T24:00:00Z",
                              "2026-06-21T10:60:00Z", "2026-06-21T10:00:60Z", "2026-06-21T10:00:00.Z",
                              "2026-06-21T10:00:00Zz", "-026-06-21T10:00:00Z", "2026-6-21T10:00:00Z"})
        EXPECT_FALSE(parseUtc(wrong).has_value()) << wrong;
}

TEST(Utc, DeltaTIsThatOfTheAlmanacs) {
    EXPECT_NEAR(deltaT(Utc{1950, 1, 1, 0.0}.julianDay()), 29.15, 0.5);
    EXPECT_NEAR(deltaT(Utc{1977, 1, 1, 0.0}.julianDay()), 47.52, 0.5);
    EXPECT_NEAR(deltaT(Utc{2000, 1, 1, 0.0}.julianDay()), 63.83, 0.5);
    EXPECT_NEAR(deltaT(Utc{2020, 1, 1, 0.0}.julianDay()), 69.4, 3.0);
}

TEST(Sun, ExampleOfMeeus) {
    // 25.a: 1992 October 13, 0h terrestrial time; the position of VSOP87 there is 199.907372°
    const Ecliptic sun = sunPosition(centuriesOf(2448908.5));
    EXPECT_NEAR(sun.longitude, 199.90895, 2e-5);
    EXPECT_NEAR(sun.longitude, 199.907372, 0.01);
    EXPECT_NEAR(sun.distance, 0.99766, 1e-5);
    EXPECT_NEAR(obliquity(centuriesOf(2448908.5)), 23.43999, 2e-4);
}

TEST(Sun, ExampleOfTheSolarPositionAlgorithm) {
    // Reda and Andreas 2004, A.5: Golden, 2003 October 17, 12:30:30 at −7 h; 820 hPa and 11 °C lift it by 0.016332°
    const SunAndMoon sky = sunAndMoonAt(at("2003-10-17T19:30:30Z"), {39.742476, -105.1786});
    EXPECT_NEAR(sky.sun.azimuth, 194.34024, 0.01);
    EXPECT_NEAR(90.0 - sky.sun.elevation, 50.11162 + 0.016332, 0.01);
    EXPECT_NEAR(sky.sun.distance, 0.9965422974, 1e-4);
}

TEST(Sun, StandsWhereEverybodySeesIt) {
    // midsummer noon on the tropic: the zenith; the poles: its declination
    EXPECT_GT(sunAndMoonAt(at("2026-06-21T12:02:00Z"), {23.44, 0.0}).sun.elevation, 89.5);
    EXPECT_NEAR(sunAndMoonAt(at("2026-06-21T08:00:00Z"), {90.0, 0.0}).sun.elevation, 23.436, 0.01);
    EXPECT_NEAR(sunAndMoonAt(at("2026-06-21T08:00:00Z"), {-90.0, 0.0}).sun.elevation, -23.436, 0.01);
    EXPECT_NEAR(sunAndMoonAt(at("2026-03-20T06:07:30Z"), {0.0, 0.0}).sun.azimuth, 90.0, 0.5);  // rises in the east
    EXPECT_NEAR(sunAndMoonAt(at("2026-03-20T18:07:30Z"), {0.0, 0.0}).sun.azimuth, 270.0, 0.5);
    const SunAndMoon noon = sunAndMoonAt(at("2026-12-21T12:00:00Z"), {51.5, 0.0});
    EXPECT_NEAR(noon.sun.azimuth, 180.0, 1.5);
    EXPECT_NEAR(noon.sun.elevation, 90.0 - 51.5 - 23.44, 0.05);
}

TEST(Sun, RefractionIsThatOfTheAlgorithm) {
    // at 820 hPa and 11 °C the example has 0.016332°
    EXPECT_NEAR(refraction(39.872046) * 820.0 / 1010.0 * 283.0 / 284.0, 0.016332, 2e-6);
    EXPECT_NEAR(refraction(0.0), 0.48, 0.02);
    EXPECT_EQ(refraction(-1.0), 0.0);
    EXPECT_NEAR(refraction(90.0), 0.0, 1e-3);
}

TEST(Moon, ExampleOfMeeus) {
    // 47.a: 1992 April 12, 0h terrestrial time
    const Ecliptic moon = moonPosition(centuriesOf(2448724.5));
    EXPECT_NEAR(moon.longitude, 133.162655, 0.01);
    EXPECT_NEAR(moon.latitude, -3.229126, 0.01);
    EXPECT_NEAR(moon.distance, 368409.7, 60.0);
    // 48.a: the same moment
    EXPECT_NEAR(sunAndMoonAt(at("1992-04-12T00:00:00Z"), {0.0, 0.0}).moonPhaseAngle, 69.0756, 0.02);
}

double apart(const Horizontal& a, const Horizontal& b) {
    return glm::degrees(
        std::acos(glm::dot(skyDirection(a.azimuth, a.elevation), skyDirection(b.azimuth, b.elevation))));
}

TEST(Moon, CoversTheSunInEclipses) {
    // greatest eclipses by NASA: 1999 in Romania, 2009 in the Pacific, 2017 in Kentucky, 2024 in Mexico
    EXPECT_LT(apart(sunAndMoonAt(at("1999-08-11T11:03:05Z"), {45.08, 24.30}).sun,
                    sunAndMoonAt(at("1999-08-11T11:03:05Z"), {45.08, 24.30}).moon),
              0.03);
    const SunAndMoon pacific = sunAndMoonAt(at("2009-07-22T02:35:19Z"), {24.21, 144.11});
    EXPECT_LT(apart(pacific.sun, pacific.moon), 0.03);
    const SunAndMoon kentucky = sunAndMoonAt(at("2017-08-21T18:25:32Z"), {36.97, -87.67});
    EXPECT_LT(apart(kentucky.sun, kentucky.moon), 0.03);
    const SunAndMoon mexico = sunAndMoonAt(at("2024-04-08T18:17:18Z"), {25.29, -104.14});
    EXPECT_LT(apart(mexico.sun, mexico.moon), 0.03);
}

TEST(Moon, IsFullInTheEarthsShadow) {
    EXPECT_LT(sunAndMoonAt(at("2018-07-27T20:21:44Z"), {0.0, 0.0}).moonPhaseAngle, 0.2);
    EXPECT_GT(sunAndMoonAt(at("1999-08-11T11:03:05Z"), {0.0, 0.0}).moonPhaseAngle, 178.0);
}

TEST(Moon, Brightness) {
    // 132.1 klx of the sun give 0.33 lx of the full moon, both at the top of the air; half the moon a tenth of it
    EXPECT_NEAR(132.1e3 * moonShare(0.0), 0.33, 0.003);
    EXPECT_NEAR(moonShare(90.0) / moonShare(0.0), 0.091, 0.002);
    EXPECT_EQ(moonShare(-30.0), moonShare(30.0));
}

}  // namespace
}  // namespace lumulus::scene
