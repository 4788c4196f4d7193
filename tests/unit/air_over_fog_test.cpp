// Level fog in an atmosphere: fog that is hardly there leaves the light of the atmosphere, and layers scatter as their
// phase functions say.
#include "light/fog_light/air_over_fog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/sunlight.h"

namespace lumulus::fog_light {
namespace {

using std::numbers::pi;

glm::dvec3 towards(double elevation, double azimuth) {
    const double e = elevation * pi / 180.0, a = azimuth * pi / 180.0;
    return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

TEST(FogLayer, MomentsAreThoseOfThePhaseFunction) {
    for (const Scatterer scatterer : {Scatterer::droplets, Scatterer::molecules, Scatterer::aerosol}) {
        FogLayer layer;
        layer.scatterer = scatterer;
        layer.g = 0.7;
        const std::vector<double> moments = layer.moments(4);
        const int steps = 200000;
        double sums[3] = {};
        for (int i = 0; i < steps; ++i) {
            const double c = -1.0 + 2.0 * (i + 0.5) / steps, p = 4.0 * pi / steps * layer.phase(c);
            sums[0] += p, sums[1] += p * c, sums[2] += p * (1.5 * c * c - 0.5);
        }
        for (std::size_t l = 0; l < 3; ++l) EXPECT_NEAR(moments[l], sums[l], 1e-6) << l;
    }
}

class ThinFog : public testing::TestWithParam<double> {
  protected:
    ThinFog() {
        sky_.aerosolDepth = 1e-4;  // tables of the atmosphere have few moments of what aerosol scatters twice
        sun_ = {towards(GetParam(), 70.0), scene::sunAboveAir};
        fog_.scattering = glm::dvec3(1e-12);
        fog_.bottom = 100.0, fog_.top = 700.0;
    }

    scene::Sky sky_;
    scene::Sun sun_;
    FogLayer fog_;
    const scene::Ground ground_{glm::dvec3(0.3), 100.0};
};

/// The planet is flat below the top of the fog, and light that the air below it sends has colours instead of
/// wavelengths.
TEST_P(ThinFog, LeavesTheLightOfTheAtmosphere) {
    const sky::Atmosphere atmosphere(sky_, ground_, 0.53);
    const AirOverFog air(atmosphere, {sun_}, {fog_}, ground_.albedo, 2500.0);
    std::vector<FogLayer> layers{fog_};
    for (const FogLayer& layer : air.layers()) layers.push_back(layer);
    const FogLight light(layers, air.setting());
    const FogSurroundings around{light, &air};
    for (const double height : {120.0, 500.0, 701.0, 1700.0}) {
        const glm::dvec3 point(0.0, height, 0.0);
        const glm::dvec3 sun = atmosphere.sunColour(point, sun_.directionTo);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(around.sunShare(height)[c] / sun[c], 1.0, 0.01) << height;
        for (const double elevation : {-80.0, -30.0, -12.0, 12.0, 30.0, 80.0})
            for (const double azimuth : {50.0, 170.0, 250.0}) {
                const glm::dvec3 direction = towards(elevation, azimuth);
                const glm::dvec3 expected = atmosphere.radiance(point, direction, sun_.directionTo),
                                 seen = around.radiance(height, direction);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.03) << height << " " << elevation << " " << azimuth;
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Suns, ThinFog, testing::Values(60.0, 20.0, 8.0));

/// A low sun comes through the kilometres of air that haze reaches up into as through round air, whose colours change
/// on the way: on the ground nearly so, and between it and the top within some percents.
TEST(AirOverFog, ALowSunIsAsBrightInHighHaze) {
    const scene::Ground ground{glm::dvec3(0.2), 0.0};
    const sky::Atmosphere atmosphere(scene::Sky(), ground, 0.53);
    FogLayer haze;
    haze.scattering = glm::dvec3(1e-12);
    haze.bottom = 0.0, haze.top = 3300.0;
    for (const double elevation : {5.0, 10.0}) {
        const scene::Sun sun{towards(elevation, 70.0), scene::sunAboveAir};
        const AirOverFog air(atmosphere, {sun}, {haze}, ground.albedo, 3300.0);
        std::vector<FogLayer> layers{haze};
        for (const FogLayer& layer : air.layers()) layers.push_back(layer);
        const FogLight light(layers, air.setting());
        const FogSurroundings around{light, &air};
        for (const double height : {1.0, 300.0, 1000.0}) {
            const glm::dvec3 expected = atmosphere.sunColour({0.0, height, 0.0}, sun.directionTo);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(around.sunShare(height)[c] / expected[c], 1.0, height < 10.0 ? 0.005 : 0.05)
                    << elevation << " " << height;
        }
    }
}

/// A fog that reflects lights up the air above it, as a ground of its albedo does.
TEST(AirOverFog, BrightFogCountsAsBrightGround) {
    const sky::Atmosphere atmosphere(scene::Sky{}, scene::Ground{glm::dvec3(0.05), 0.0}, 0.53);
    FogLayer fog;
    fog.scattering = glm::dvec3(0.1);
    fog.top = 200.0;  // an optical depth of 20: by two streams 0.67 is reflected
    const AirOverFog air(atmosphere, {{towards(50.0, 0.0), scene::sunAboveAir}}, {fog}, glm::dvec3(0.05), 0.0);
    const glm::dvec4 albedo = air.atmosphere().air().groundAlbedo;
    for (int i = 0; i < 4; ++i) {
        EXPECT_GT(albedo[i], 0.62);
        EXPECT_LT(albedo[i], 0.74);
    }
    const glm::dvec3 high = towards(60.0, 180.0), point(0.0, 201.0, 0.0);
    EXPECT_GT(air.above(201.0, high).radiance.b, 1.1 * atmosphere.radiance(point, high, towards(50.0, 0.0)).b);
}

}  // namespace
}  // namespace lumulus::fog_light
