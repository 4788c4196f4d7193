#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "reference/air.h"
#include "reference/ground.h"
#include "support/statistics.h"

/// Light that air, and what else is in it, scatter once.
namespace lumulus::reference {

/// What else scatters at a height above the ground, times its phase function at an angle (1 − cos) [1/(m sr)].
using OtherScattering = std::function<Four(double height, double away)>;

/// Light of one scattering by numeric integration along the ray, at each wavelength.
inline Four onceScattered(const Air& air, const AirMedium& medium, const Ray& ray, const glm::dvec3& toSun,
                          const OtherScattering& other) {
    const double away = oneMinusCosBetween(ray.direction, toSun);
    constexpr double endless = std::numeric_limits<double>::infinity(), length = 1200e3;
    constexpr int steps = 20'000;
    Four sum(0.0);
    for (int i = 0; i < steps; ++i) {
        // steps grow with the distance
        const double a = length * std::pow(static_cast<double>(i) / steps, 2.0);
        const double b = length * std::pow(static_cast<double>(i + 1) / steps, 2.0), t = 0.5 * (a + b);
        const glm::dvec3 point = ray.origin + t * ray.direction;
        const double height = glm::distance(point, {0.0, -planetRadius, 0.0}) - planetRadius;
        const AirParts parts = airPartsAt(height);
        const Four scattering = parts.molecules * medium.molecules * air.phase(0).evaluate(away) +
                                parts.aerosol * medium.aerosolScattering * air.phase(1).evaluate(away) +
                                other(height, away);
        sum += air.transmittance(ray, t) * scattering * air.transmittance({point, toSun}, endless) * (b - a);
    }
    return sum;
}

/// A collision drawn for one wavelength has the right light at all of them, from a throughput of any colour: within
/// four standard errors, of which one is 1 % at most, and `rounding`.
inline void expectOneScatteringOfQuadrature(const Air& air, const AirMedium& medium, const OtherScattering& other,
                                            const std::vector<double>& elevations, int samples, std::uint64_t seed,
                                            double rounding) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const glm::dvec3 toSun = scene::skyDirection(0.0, 20.0);
    const Four throughput(1.0, 0.5, 0.0, 2.0);
    Random random(seed, 0, 0);
    for (const double elevation : elevations) {
        const Ray ray{{0.0, 50.0, 0.0}, scene::skyDirection(40.0, elevation)};
        const Four expected = throughput * onceScattered(air, medium, ray, toSun, other);
        test::RunningMean mean[4];
        for (int i = 0; i < samples; ++i) {
            Four light(0.0);
            if (const auto collision = air.collide(ray, endless, throughput, random)) {
                const Four left = air.scattered(ray, *collision, throughput);
                EXPECT_LE(left.x + left.y + left.z + left.w, 3.5 * (1.0 + 1e-9)) << "light never grows";
                const glm::dvec3 point = ray.origin + collision->metres * ray.direction;
                const double away = oneMinusCosBetween(ray.direction, toSun);
                light = left * air.phase(collision->medium).evaluate(away) * air.transmittance({point, toSun}, endless);
            }
            for (int c = 0; c < 4; ++c) mean[c].add(light[c]);
        }
        for (int c = 0; c < 4; ++c) {
            EXPECT_NEAR(mean[c].mean(), expected[c], 4.0 * mean[c].standardError() + rounding * expected[c])
                << elevation << "°, wavelength " << c;
            EXPECT_LE(mean[c].standardError(), 0.01 * expected[c]);
        }
    }
}

}  // namespace lumulus::reference
