#pragma once

#include <array>

/// Real spherical harmonics of light that is symmetric about the plane of the upward direction and the sun.
namespace lumulus::sky {

constexpr int highestDegree = 4;
/// Those of degree l and order m, 0 ≤ m ≤ l, stand at l (l + 1) / 2 + m.
constexpr int harmonicCount = (highestDegree + 1) * (highestDegree + 2) / 2;
/// The harmonic of degree 0 and order 0.
constexpr double meanHarmonic = 0.28209479177387814;

constexpr int harmonicAt(int degree, int order) {
    return degree * (degree + 1) / 2 + order;
}

/// A harmonic is its factor by height and the factor of its order by azimuth.
using HeightFactors = std::array<float, harmonicCount>;
using AzimuthFactors = std::array<float, highestDegree + 1>;

/// `up`: cosine of the direction to the upward one.
HeightFactors heightFactors(double up);

/// sᵐ cos mφ, where s cos φ = `across` is the direction's part across the upward one, in the plane of the sun.
inline AzimuthFactors azimuthFactors(float up, float across) {
    const float sine2 = 1.0F - up * up, second = 2.0F * across * across - sine2;
    const float third = 2.0F * across * second - sine2 * across;
    return {1.0F, across, second, third, 2.0F * across * third - sine2 * second};
}

}  // namespace lumulus::sky
