#include "light/fog_change/fog_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shared/lit_fog.h"

namespace lumulus::fog_change {
namespace {

using std::numbers::pi;

fog_light::FogLayer slab(double scattering, double bottom, double top) {
    fog_light::FogLayer layer;
    layer.scattering = glm::dvec3(scattering);
    layer.bottom = bottom;
    layer.top = top;
    return layer;
}

/// A box of one extinction 200 m wide, from 100 to 300 m above the ground.
CloudGrid box(double extinction) {
    return {{-100.0, 100.0, -100.0}, {100.0, 300.0, 100.0}, extinction};
}

CloudMedium mediumOf(double albedo) {
    return {glm::dvec3(albedo), [](double u) { return 1.0 - 2.0 * u; }};
}

FogChange changeIn(const fog_light::FogLight& light, const CloudGrid& clouds, double albedo, std::uint64_t starts,
                   std::uint64_t seed = 1) {
    const fog_light::FogSurroundings surroundings{light, nullptr};
    const CloudMedium medium = mediumOf(albedo);
    return {{surroundings, light.setting().toSun, light.setting().sun, clouds, medium, starts, seed},
            stopIfInterrupted};
}

fog_light::FogSetting sunny() {
    fog_light::FogSetting setting;
    setting.toSun = glm::normalize(glm::dvec3(1.0, 1.0, 0.0));
    setting.sun = glm::dvec3(3.0);
    setting.sky = glm::dvec3(0.2);
    setting.groundHeight = 0.0;
    setting.groundAlbedo = glm::dvec3(0.3);
    return setting;
}

/// ∫ of the change over all directions.
double fluence(const FogChange& change, const glm::dvec3& point) {
    const auto harmonics = harmonicsOf({0.0F, 1.0F, 0.0F});
    return 4.0 * pi * static_cast<double>(change.cells().at(point, harmonics).bands[0].y);
}

TEST(CutPhase, HasThePeakThatShadersHave) {
    for (const double g : {-0.5, 0.3, 0.6, 0.85, 0.9}) {
        const CutPhase phase(
            [&](double cosine) {
                return static_cast<double>(shared::fogPhase(static_cast<float>(g), static_cast<float>(cosine)));
            },
            static_cast<double>(shared::FOG_CUT));
        EXPECT_NEAR(phase.peak(), shared::peakShare(static_cast<float>(g)), 2e-3) << g;
        // the peak and what is left have the mean cosine of the whole
        EXPECT_NEAR(phase.peak() * phase.peakCosine() + (1.0 - phase.peak()) * phase.moments()[1], g, 2e-3) << g;
        double sum = 0.0;
        for (int i = 0; i < 10000; ++i) sum += phase.sampleCosine((i + 0.5) / 10000) / 10000;
        EXPECT_NEAR(sum, phase.moments()[1], 2e-3) << g;
    }
}

/// Light walks as far as the optical depth of its way says.
TEST(FogPaths, CollideWhereTheDepthIsReached) {
    fog_light::FogLayer thinning = slab(0.01, 50.0, 900.0);
    thinning.falloff = 0.004;
    const FogPaths paths({thinning});
    for (const double rise : {-0.7, -1e-12, 0.01, 0.6})
        for (const double height : {120.0, 700.0, 950.0})
            for (const double depth : {0.05, 0.4, 2.0}) {
                const auto found = paths.collision(height, rise, 1e7, [&] { return depth; });
                const double most = paths.depth(height, rise, 1e7).x;
                ASSERT_EQ(found.has_value(), most > depth) << rise << " " << height << " " << depth;
                if (!found) continue;
                EXPECT_NEAR(paths.depth(height, rise, found->distance).x, depth, 1e-6 * depth);
            }
}

TEST(FogChange, ACloudThatIsNotThereChangesNothing) {
    const fog_light::FogLight light({slab(0.003, 0.0, 500.0)}, sunny());
    const FogChange change = changeIn(light, box(0.0), 1.0, 4000);
    for (const double x : {-1500.0, -150.0, 0.0, 120.0, 900.0}) {
        const FogChange::Scattered found = change.scatteredAt({x, 150.0, 20.0}, {0.0, 0.0, 1.0});
        EXPECT_EQ(found.turned, glm::dvec3(0.0));
        EXPECT_EQ(found.once, glm::dvec3(0.0));
    }
}

/// Fog, cloud, ground and sky of one radiance: nobody sees a cloud.
TEST(FogChange, AFurnaceHasNone) {
    fog_light::FogSetting setting;
    setting.sky = glm::dvec3(1.0);
    setting.groundHeight = 0.0;
    setting.groundAlbedo = glm::dvec3(1.0);
    const fog_light::FogLight light({slab(0.003, 0.0, 500.0)}, setting);
    const FogChange change = changeIn(light, box(0.05), 1.0, 10000);
    for (const double x : {-900.0, -150.0, 0.0, 120.0}) EXPECT_NEAR(fluence(change, {x, 150.0, 20.0}), 0.0, 1e-3);
}

/// A black cloud in fog that hardly scatters keeps off the light of the sky as far as it is opaque.
TEST(FogChange, ABlackCloudHidesTheSkyBehindIt) {
    constexpr double extinction = 0.02;
    fog_light::FogSetting setting;
    setting.sky = glm::dvec3(1.0);
    const fog_light::FogLight light({slab(1e-7, 0.0, 500.0)}, setting);
    const CloudGrid cloud = box(extinction);
    const FogChange change = changeIn(light, cloud, 0.0, 200000);
    constexpr int directions = 20000;
    double expected = 0.0, found = 0.0;
    for (int i = 0; i < directions; ++i) {
        const double cosine = 1.0 - 2.0 * (i + 0.5) / directions;
        const glm::dvec2 part = partInBox(cloud.lower(), cloud.upper(), {190.0, 180.0, 0.0},
                                          turned({0.0, 1.0, 0.0}, cosine, i * 2.399963229728653));
        if (part.x < part.y) expected += 4.0 * pi / directions * std::expm1(-extinction * (part.y - part.x));
    }
    for (const glm::dvec3 point : {glm::dvec3(190.0, 180.0, 0.0), glm::dvec3(-190.0, 180.0, 0.0),
                                   glm::dvec3(0.0, 180.0, 190.0), glm::dvec3(0.0, 180.0, -190.0)})
        found += 0.25 * fluence(change, point);
    EXPECT_NEAR(found, expected, -0.12 * expected);  // some 600 photons
}

/// A white cloud in the sun lights the fog before it and darkens that behind it.
TEST(FogChange, ACloudLightsTheSunnySideAndDarkensTheOther) {
    const fog_light::FogLight light({slab(0.003, 0.0, 500.0)}, sunny());
    const FogChange change = changeIn(light, box(0.05), 1.0, 40000);
    EXPECT_GT(fluence(change, {140.0, 200.0, 0.0}), 0.1);
    EXPECT_LT(fluence(change, {-200.0, 60.0, 0.0}), -0.05);
    // seen towards the sun from its shadow, what the fog scatters of its beam is missing
    EXPECT_LT(change.scatteredAt({-160.0, 40.0, 0.0}, -light.setting().toSun).once.y, 0.0);
}

TEST(FogChange, MorePhotonsHaveLessNoise) {
    const fog_light::FogLight light({slab(0.003, 0.0, 500.0)}, sunny());
    const auto varianceOf = [&](std::uint64_t starts) {
        constexpr int seeds = 12;
        double sum = 0.0, squares = 0.0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const double value = fluence(changeIn(light, box(0.02), 1.0, starts, seed), {-250.0, 150.0, 30.0});
            sum += value;
            squares += value * value;
        }
        return (squares - sum * sum / seeds) / (seeds - 1);
    };
    const double ratio = varianceOf(1000) / varianceOf(16000);  // 16; each variance is off by a factor of 1.5
    EXPECT_GT(ratio, 4.0);
    EXPECT_LT(ratio, 64.0);
}

}  // namespace
}  // namespace lumulus::fog_change
