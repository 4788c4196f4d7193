#include "light/fog_light/fog_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/fog_light/rows.h"

namespace lumulus::fog_light {
namespace {

using std::numbers::pi;

FogLayer slab(double scattering, double bottom, double top, double g = 0.85) {
    FogLayer layer;
    layer.scattering = glm::dvec3(scattering);
    layer.g = g;
    layer.bottom = bottom;
    layer.top = top;
    return layer;
}

FogLayer haze() {
    FogLayer layer = slab(0.002, 0.0, 3000.0);
    layer.falloff = 0.004;
    return layer;
}

glm::dvec3 towards(double elevation, double azimuth) {
    const double e = elevation * pi / 180.0, a = azimuth * pi / 180.0;
    return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

/// A sky of one radiance round a world that does not absorb: all of it has that radiance.
TEST(FogLight, ConstantSkyShinesThroughWhateverScatters) {
    FogLayer other = slab(0.01, 200.0, 400.0, 0.6);
    for (const bool ground : {false, true}) {
        FogSetting setting;
        setting.sky = glm::dvec3(1.0, 2.0, 3.0);
        if (ground) setting.groundHeight = -100.0;
        setting.groundAlbedo = glm::dvec3(1.0);
        const FogLight light({haze(), other}, setting);
        for (const double height : {-50.0, 0.0, 210.0, 390.0, 1500.0, 3000.0, 9000.0})
            for (const double elevation : {-90.0, -20.0, -1.0, 0.3, 5.0, 60.0}) {
                const glm::dvec3 seen = light.radiance(height, towards(elevation, 40.0)) / setting.sky;
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 1.0, 1e-4) << height << " " << elevation;
            }
        EXPECT_NEAR(light.irradianceBelow().x, pi, 1e-4 * pi);
    }
}

/// Light adds up: sun and a sky of another colour, bright about it, send what each sends by itself.
TEST(FogLight, SunAndSkyAddUp) {
    FogSetting alone, both;
    alone.toSun = both.toSun = towards(10.0, 0.0);
    alone.sun = both.sun = {3.0, 2.0, 0.5};
    alone.groundHeight = both.groundHeight = 0.0;
    alone.groundAlbedo = both.groundAlbedo = glm::dvec3(0.3);
    both.skyAt = [](double up, double azimuth) {
        return glm::dvec3(0.1, 0.3, 1.0) * (1.0 + 4.0 * std::exp(-up) * std::exp(3.0 * (std::cos(azimuth) - 1.0)));
    };
    const std::vector<FogLayer> layers{haze()};
    FogSetting dark = both;
    dark.sun = glm::dvec3(0.0);
    const FogLight expected(layers, alone), light(layers, both), ofSky(layers, dark);
    ASSERT_EQ(light.scattered().size(), expected.scattered().size());
    float most = 0.0F;
    for (const glm::vec3& value : expected.scattered()) most = std::max({most, value.r, value.g, value.b});
    for (std::size_t i = 0; i < light.scattered().size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(light.scattered()[i][c] - ofSky.scattered()[i][c], expected.scattered()[i][c], 1e-4F * most)
                << i << " " << c;
}

/// Transmittance of a layer by doubling (scripts/study/layers.py): tau 1, g 0.85, sun at 30 degrees.
TEST(FogLight, TransmitsWhatDoublingSays) {
    for (const int parts : {1, 2}) {
        FogSetting setting;
        setting.toSun = towards(30.0, 0.0);
        setting.sun = glm::dvec3(2.0);
        setting.groundHeight = 0.0;
        std::vector<FogLayer> layers(static_cast<std::size_t>(parts), slab(0.001 / parts, 0.0, 1000.0));
        const FogLight light(layers, setting);
        const double through =
            (setting.sun.x * 0.5 * light.sunTransmittance(0.0).x + light.irradianceBelow().x) / (setting.sun.x * 0.5);
        EXPECT_NEAR(through, 0.8351, 2e-4);
    }
}

/// The sun's light that a thin layer scatters once, in closed form (METHODS: airlight of a slab).
TEST(FogLight, AirlightOfASlabIsTheClosedForm) {
    const double sigma = 1e-5, depth = 500.0;
    FogSetting setting;
    setting.toSun = towards(40.0, 0.0);
    setting.sun = glm::dvec3(3.0);
    const FogLight light({slab(sigma, 0.0, depth, 0.7)}, setting);
    const Vector cosines = rowCosines();
    for (std::size_t row = 30; row < cosines.size(); row += 5) {
        const double mu = cosines[row], sun = setting.toSun.y;
        const double extinct = sigma * (1.0 - std::pow(0.7, 32.0));
        const double z = extinct * depth * (1.0 / mu - 1.0 / sun);
        const double expected = sigma * depth / mu * std::exp(-extinct * depth / mu) * std::expm1(z) / z;
        const double seen = static_cast<double>(light.once()[0][row].x) * -std::expm1(-extinct * depth / mu);
        EXPECT_NEAR(seen / expected, 1.0, 1e-3) << mu;
    }
    const glm::dvec3 view = towards(25.0, 30.0);
    const double cosine = glm::dot(view, setting.toSun), phase = 0.51 / (4.0 * pi * std::pow(1.49 - 1.4 * cosine, 1.5));
    const double once = 3.0 * phase * sigma * depth / view.y;
    EXPECT_NEAR(light.scatteredLight(0.0, view).x / once, 1.0, 0.03);  // with attenuation and what is scattered twice
}

}  // namespace
}  // namespace lumulus::fog_light
