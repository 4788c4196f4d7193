#include "scene/ephemeris.h"

#include <algorithm>
#include <cmath>

namespace lumulus::scene {
namespace {

constexpr double earthRadius = 6378.14;           // km, at the equator
constexpr double astronomicalUnit = 149597870.7;  // km

double sine(double degrees) {
    return std::sin(glm::radians(degrees));
}

double cosine(double degrees) {
    return std::cos(glm::radians(degrees));
}

double turned(double degrees) {
    const double rest = std::fmod(degrees, 360.0);
    return rest < 0.0 ? rest + 360.0 : rest;
}

/// Longitude of the ascending node of the moon's orbit.
double nodeOf(double centuries) {
    return 125.04452 - 1934.136261 * centuries;
}

/// Nutation in longitude (ch. 22, low accuracy).
double nutation(double centuries) {
    const double node = nodeOf(centuries);
    const double sun = 280.4665 + 36000.7698 * centuries, moon = 218.3165 + 481267.8813 * centuries;
    return (-17.20 * sine(node) - 1.32 * sine(2.0 * sun) - 0.23 * sine(2.0 * moon) + 0.21 * sine(2.0 * node)) / 3600.0;
}

/// Apparent sidereal time at Greenwich (ch. 12). `days` since noon of the 1st of January 2000, universal time.
double siderealTime(double days, double centuries) {
    const double t = days / 36525.0;
    const double mean = 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t - t * t * t / 38710000.0;
    return turned(mean + nutation(centuries) * cosine(obliquity(centuries)));
}

/// The vector to a body in km: x to the equinox, z to the north pole.
glm::dvec3 equatorial(const Ecliptic& body, double tilt, double unit) {
    const double x = cosine(body.latitude) * cosine(body.longitude);
    const double y = cosine(body.latitude) * sine(body.longitude), z = sine(body.latitude);
    return unit * body.distance * glm::dvec3(x, y * cosine(tilt) - z * sine(tilt), y * sine(tilt) + z * cosine(tilt));
}

/// A place in the sky of an observer whose meridian has the sidereal time `sidereal`; `unit` of its distance in km.
Horizontal seenFrom(const Place& place, double sidereal, const glm::dvec3& body, double unit) {
    // on the ellipsoid, ch. 11
    const double flattened = glm::degrees(std::atan(0.99664719 * std::tan(glm::radians(place.latitude))));
    const double up = earthRadius * 0.99664719 * sine(flattened), out = earthRadius * cosine(flattened);
    const glm::dvec3 towards = body - glm::dvec3(out * cosine(sidereal), out * sine(sidereal), up);
    const glm::dvec3 east(-sine(sidereal), cosine(sidereal), 0.0);
    const glm::dvec3 zenith(cosine(place.latitude) * cosine(sidereal), cosine(place.latitude) * sine(sidereal),
                            sine(place.latitude));
    const glm::dvec3 north = glm::cross(zenith, east);
    const double e = glm::dot(towards, east), n = glm::dot(towards, north), z = glm::dot(towards, zenith);
    return {turned(glm::degrees(std::atan2(e, n))), glm::degrees(std::atan2(z, std::hypot(e, n))),
            glm::length(towards) / unit};
}

}  // namespace

double obliquity(double centuries) {
    const double t = centuries;
    const double mean = 23.4392911 - 0.0130042 * t - 1.64e-7 * t * t + 5.04e-7 * t * t * t;
    return mean + 0.00256 * cosine(nodeOf(t));
}

Ecliptic sunPosition(double centuries) {
    const double t = centuries;
    const double meanLongitude = 280.46646 + 36000.76983 * t + 0.0003032 * t * t;
    const double anomaly = 357.52911 + 35999.05029 * t - 0.0001537 * t * t;
    const double eccentricity = 0.016708634 - 0.000042037 * t - 0.0000001267 * t * t;
    const double centre = (1.914602 - 0.004817 * t - 0.000014 * t * t) * sine(anomaly) +
                          (0.019993 - 0.000101 * t) * sine(2.0 * anomaly) + 0.000289 * sine(3.0 * anomaly);
    const double distance =
        1.000001018 * (1.0 - eccentricity * eccentricity) / (1.0 + eccentricity * cosine(anomaly + centre));
    return {turned(meanLongitude + centre - 0.00569 - 0.00478 * sine(nodeOf(t))), 0.0, distance};
}

SunAndMoon sunAndMoonAt(const Utc& utc, const Place& place) {
    constexpr double noon2000 = 2451545.0;
    const double days = utc.julianDay() - noon2000;
    const double centuries = (days + deltaT(utc.julianDay()) / 86400.0) / 36525.0;
    const double tilt = obliquity(centuries);
    const double sidereal = siderealTime(days, centuries) + place.longitude;
    const Ecliptic sun = sunPosition(centuries);
    Ecliptic moon = moonPosition(centuries);
    moon.longitude += nutation(centuries);
    SunAndMoon result;
    result.sun = seenFrom(place, sidereal, equatorial(sun, tilt, astronomicalUnit), astronomicalUnit);
    result.moon = seenFrom(place, sidereal, equatorial(moon, tilt, 1.0), 1.0);
    const double apart =
        std::acos(std::clamp(cosine(moon.latitude) * cosine(moon.longitude - sun.longitude), -1.0, 1.0));
    const double sunDistance = sun.distance * astronomicalUnit;
    result.moonPhaseAngle =
        glm::degrees(std::atan2(sunDistance * std::sin(apart), moon.distance - sunDistance * std::cos(apart)));
    return result;
}

double refraction(double elevation) {
    constexpr double lowest = -(0.26667 + 0.5667);  // the sun's upper rim at the visible horizon
    if (elevation < lowest) return 0.0;
    return 1.02 / (60.0 * std::tan(glm::radians(elevation + 10.3 / (elevation + 5.11))));
}

glm::dvec3 apparentDirection(const Sun& sun) {
    const glm::dvec3& to = sun.directionTo;
    if (!sun.refraction) return to;
    const double elevation = glm::degrees(std::asin(std::clamp(to.y, -1.0, 1.0)));
    const double azimuth = glm::degrees(std::atan2(to.x, -to.z));
    return skyDirection(azimuth, std::min(elevation + refraction(elevation), 90.0));
}

double moonShare(double phaseAngle) {
    const double angle = std::abs(phaseAngle), square = angle * angle;
    const double magnitude = -12.73 + 0.026 * angle + 4e-9 * square * square;
    return std::pow(10.0, -0.4 * (magnitude + 26.74));
}

}  // namespace lumulus::scene
