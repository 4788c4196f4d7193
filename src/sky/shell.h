#pragma once

#include <cmath>
#include <limits>

/// The shell of air around a sphere: distances in forms that keep their digits from 2 m above the ground to orbit.
/// Heights are metres above the ground; `up` is the cosine of a ray's angle to the local upward direction.
namespace lumulus::sky {

inline constexpr double planetRadius = 6.36e6;  ///< m
inline constexpr double airTop = 1.0e5;         ///< m above the ground: what is higher is empty

/// Height after `t` metres of a ray. |P| − R would lose the ground's distance in single precision.
inline double heightAlong(double height, double up, double t) {
    const double r = planetRadius + height;
    const double q = height * (planetRadius + r) + 2.0 * r * up * t + t * t;
    return q / (planetRadius + std::sqrt(std::max(0.0, planetRadius * planetRadius + q)));
}

/// Cosine at which a ray from this height touches the ground, or a sphere around the planet `floor` metres above it.
inline double horizonCosine(double height, double floor = 0.0) {
    return -std::sqrt((height - floor) * (2.0 * planetRadius + (height + floor))) / (planetRadius + height);
}

/// Distance to the ground, or to such a sphere from above it [m], or infinity.
inline double distanceToGround(double height, double up, double floor = 0.0) {
    const double b = (planetRadius + height) * up, c = (height - floor) * (2.0 * planetRadius + (height + floor));
    const double root = b * b - c;
    if (b >= 0.0 || root < 0.0) return std::numeric_limits<double>::infinity();
    return c / (-b + std::sqrt(root));
}

/// Distance from within the air to its top [m].
inline double distanceToTop(double height, double up) {
    const double r = planetRadius + height, b = r * up;
    const double c = (airTop - height) * (planetRadius + airTop + r);
    const double root = std::sqrt(std::max(0.0, b * b + c));
    return b > 0.0 ? c / (b + root) : root - b;
}

/// Distance from above the air to where a ray enters it [m], or infinity.
inline double distanceToAir(double height, double up) {
    const double r = planetRadius + height, b = r * up;
    const double c = (height - airTop) * (planetRadius + airTop + r);
    const double root = b * b - c;
    if (b >= 0.0 || root < 0.0) return std::numeric_limits<double>::infinity();
    return c / (-b + std::sqrt(root));
}

}  // namespace lumulus::sky
