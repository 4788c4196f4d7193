#include "render/ambient.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace lumulus {
namespace {

using std::numbers::pi;

/// A panorama of a radiance by direction, the same for all channels.
template <class Radiance>
AmbientLight projected(const Radiance& radiance) {
    constexpr int width = 128, height = 64;
    std::vector<float> values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double elevation = pi * (0.5 - (y + 0.5) / height), azimuth = 2.0 * pi * ((x + 0.5) / width - 0.5);
            values.push_back(
                static_cast<float>(radiance(scene::skyDirection(azimuth * 180.0 / pi, elevation * 180.0 / pi))));
        }
    return projectPanorama(values, values, values, width, height);
}

TEST(Ambient, ConstantLightFillsTheFirstBandAlone) {
    const AmbientLight light = projected([](const glm::dvec3&) { return 2.0; });
    EXPECT_NEAR(light.coefficients[0].g, 2.0 * std::sqrt(4.0 * pi), 1e-5);
    for (std::size_t i = 1; i < 9; ++i) EXPECT_NEAR(light.coefficients[i].g, 0.0, 2e-3);
    EXPECT_NEAR(light.irradiance({0.6, 0.0, 0.8}).r, 2.0 * pi, 5e-3);
}

TEST(Ambient, EveryBasisFunctionFindsItself) {
    for (std::size_t k = 0; k < 9; ++k) {
        const AmbientLight light = projected([k](const glm::dvec3& d) { return ambientBasis(d)[k]; });
        for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(light.coefficients[i].b, i == k ? 1.0 : 0.0, 3e-3) << k << i;
    }
}

/// A bright half above: the irradiance is π L (1 + cos) / 2, of which three bands miss 1/16 at most (Ramamoorthi).
TEST(Ambient, TheSkyLightsWhatFacesIt) {
    const AmbientLight light = projected([](const glm::dvec3& d) { return d.y > 0.0 ? 1.0 : 0.0; });
    for (const double y : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        const glm::dvec3 normal(std::sqrt(1.0 - y * y), y, 0.0);
        EXPECT_NEAR(light.irradiance(normal).r, 0.5 * pi * (1.0 + y), 0.02) << y;
    }
}

}  // namespace
}  // namespace lumulus
