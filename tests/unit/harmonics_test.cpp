#include "sky/harmonics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lumulus::sky {
namespace {

using std::numbers::pi;

/// Integrals of the products of two over the sphere are 1 for the same two, else 0.
TEST(Harmonics, AreOrthonormal) {
    std::array<std::array<double, harmonicCount>, harmonicCount> products{};
    constexpr int heights = 400, azimuths = 16;
    for (int j = 0; j < heights; ++j)
        for (int i = 0; i < azimuths; ++i) {
            const double up = -1.0 + 2.0 * (j + 0.5) / heights;
            const double across = std::sqrt(1.0 - up * up) * std::cos(2.0 * pi * (i + 0.5) / azimuths);
            const HeightFactors byHeight = heightFactors(up);
            const AzimuthFactors byAzimuth = azimuthFactors(static_cast<float>(up), static_cast<float>(across));
            std::array<double, harmonicCount> values{};
            for (int l = 0; l <= highestDegree; ++l)
                for (int m = 0; m <= l; ++m) {
                    const auto k = static_cast<std::size_t>(harmonicAt(l, m));
                    values[k] = static_cast<double>(byHeight[k] * byAzimuth[static_cast<std::size_t>(m)]);
                }
            for (std::size_t a = 0; a < harmonicCount; ++a)
                for (std::size_t b = 0; b < harmonicCount; ++b)
                    products[a][b] += values[a] * values[b] * 4.0 * pi / (heights * azimuths);
        }
    for (std::size_t a = 0; a < harmonicCount; ++a)
        for (std::size_t b = 0; b < harmonicCount; ++b)
            EXPECT_NEAR(products[a][b], a == b ? 1.0 : 0.0, 3e-4) << a << " " << b;
}

}  // namespace
}  // namespace lumulus::sky
