#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "reference/render.h"
#include "reference/tracer.h"
#include "stat/ball.h"
#include "support/statistics.h"

// Level layers of fog in the light of sun and sky: known answers.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double pi = glm::pi<double>();

scene::FogMedium layer(double bottom, double top, double scattering, double absorption, double g) {
    scene::FogMedium medium;
    medium.scattering = dvec3(scattering);
    medium.absorption = dvec3(absorption);
    medium.g = g;
    medium.bottom = bottom;
    medium.top = top;
    return medium;
}

/// A point-like sun that shines with `irradiance` at this cosine to the vertical, and nothing else.
scene::Scene sunScene(double irradiance, double cosine) {
    scene::Scene scene;
    scene.clouds.clear();
    scene.sky.radiance = dvec3(0.0);
    scene.sun.irradiance = dvec3(irradiance);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = dvec3(std::sqrt(1.0 - cosine * cosine), cosine, 0.0);
    return scene;
}

template <typename RayOf>
RunningMean seenBy(const scene::Scene& scene, int samples, const RayOf& rayOf) {
    const PathTracer tracer(scene, {}, Majorant::global);
    Random random(61, 0, 0);
    RunningMean mean;
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(rayOf(random), random);
        EXPECT_FALSE(sample.lost);
        mean.add(sample.radiance.x + sample.passed.x * tracer.environment().unit().x);
    }
    return mean;
}

/// Sunlight that is scattered once in a layer of extinction σ, seen from within along a direction of the cosine μ:
/// E p ω e^(−σ(H−y)/μs) (1 − e^(−σ D (1−μ/μs)))/(1 − μ/μs). The albedo is so small that there is no second scattering.
TEST(ReferenceFogLayers, AirlightHasItsClosedForm) {
    constexpr double albedo = 1e-4, extinction = 0.004, height = 300.0, y = 40.0, sun = 0.4, g = 0.6, irradiance = 3.0;
    scene::Scene scene = sunScene(irradiance, sun);
    scene.fog.media = {layer(0.0, height, albedo * extinction, (1.0 - albedo) * extinction, g)};
    for (const double up : {0.9, 0.05, -0.3}) {
        const Ray ray{{5.0, y, 7.0}, {0.0, up, -std::sqrt(1.0 - up * up)}};
        const double distance = up > 0.0 ? (height - y) / up : -y / up;
        const double cosine = glm::dot(ray.direction, scene.sun.directionTo);
        const double p = (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
        const double k = 1.0 - up / sun;
        const double expected = irradiance * p * albedo * std::exp(-extinction * (height - y) / sun) *
                                (1.0 - std::exp(-extinction * distance * k)) / k;
        const RunningMean mean = seenBy(scene, 60'000, [&](Random&) { return ray; });
        EXPECT_LT(mean.standardError(), 0.01 * expected);
        EXPECT_NEAR(mean.mean(), expected, 4.0 * mean.standardError() + 5e-4 * expected) << up;
    }
}

/// What a layer of the optical thickness 1 lets through of a sun at 60° from the vertical, straight and scattered, g
/// 0.85, black below: 0.8351 by doubling (scripts/study/layers.py).
TEST(ReferenceFogLayers, ASlabTransmitsAsByDoubling) {
    scene::Scene scene = sunScene(2.0, 0.5);  // 1 W/m² on the level
    scene.fog.media = {layer(100.0, 150.0, 0.02, 0.0, 0.85)};
    const RunningMean below = seenBy(scene, 600'000, [](Random& random) {
        return Ray{{0.0, 90.0, 0.0}, turned({0.0, 1.0, 0.0}, 1.0 - std::sqrt(random.uniform()), random)};
    });
    const double error = pi * below.standardError();
    EXPECT_LT(error, 0.004);
    EXPECT_NEAR(std::exp(-2.0) + pi * below.mean(), 0.8351, 4.0 * error + 2e-4);
}

/// Fog, a cloud and a ground that absorb nothing are as bright as the sky on every path.
TEST(ReferenceFogLayers, WhiteFurnaceIsExact) {
    scene::Scene scene;
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.05;
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.3, 1.0, 7.0);
    scene.ground = scene::Ground{dvec3(1.0), -30.0};
    scene.fog.media = {layer(-30.0, 40.0, 0.02, 0.0, 0.7), layer(-30.0, 1e9, 0.05, 0.0, -0.3)};
    scene.fog.media[1].kind = scene::MediumKind::exponential;
    scene.fog.media[1].falloff = 0.02;
    const vdb::Volume ball = ballVolume(16, 20.0);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    Random random(62, 0, 0);
    for (int i = 0; i < 3000; ++i) {
        const Ray ray{{0.0, 10.0, 90.0}, turned({0.0, 0.0, -1.0}, random.uniform(), random)};
        const PathSample sample = tracer.trace(ray, random);
        const dvec3 radiance = sample.passed * scene.sky.radiance + sample.radiance;
        EXPECT_NEAR(glm::length(radiance / scene.sky.radiance - 1.0), 0.0, 1e-10);
        EXPECT_FALSE(sample.lost);
    }
}

/// Haze over a plain, as in configs/scenes/cumulus-haze.toml.
scene::Scene hazeScene() {
    scene::Scene scene;
    scene.clouds.clear();
    scene.image.width = 16;
    scene.image.height = 9;
    scene.camera.position = dvec3(0.0, 0.0, 900.0);
    scene.camera.target = dvec3(0.0, 0.0, 0.0);
    scene.ground = scene::Ground{dvec3(0.2), -300.0};
    scene.fog.media = {layer(-300.0, std::numeric_limits<double>::infinity(), 0.002, 0.0, 0.85)};
    scene.fog.media[0].kind = scene::MediumKind::exponential;
    scene.fog.media[0].falloff = 0.004;
    return scene;
}

/// Pictures of two seeds differ in every noisy pixel, by as much as their variances say: the mean of z² over 144 pixels
/// and three channels, which go together, lies within four standard errors, √(2/144), of 1. No path is lost.
TEST(ReferenceFogLayers, TwoSeedsAreIndependentAndLoseNoPath) {
    std::vector<LayeredImage> images;
    for (const std::uint64_t seed : {1U, 2U}) {
        Renderer renderer(hazeScene(), {}, Majorant::global, seed);
        for (int i = 0; i < 100; ++i) renderer.pass([](std::uint64_t) { return true; });
        EXPECT_EQ(renderer.film().lost, 0U);
        images.push_back(renderer.picture());
    }
    double sum = 0.0;
    for (const char* channel : {"R", "G", "B"}) {
        for (std::size_t i = 0; i < images[0].pixels(); ++i) {
            const double difference = static_cast<double>(images[0].layers.at(channel)[i]) -
                                      static_cast<double>(images[1].layers.at(channel)[i]);
            const std::string variance = std::string("variance.") + channel;
            const double both = static_cast<double>(images[0].layers.at(variance)[i]) +
                                static_cast<double>(images[1].layers.at(variance)[i]);
            ASSERT_GT(both, 0.0);
            EXPECT_NE(difference, 0.0) << channel << ' ' << i;
            sum += difference * difference / both / (3.0 * 144.0);
        }
    }
    EXPECT_NEAR(sum, 1.0, 4.0 * std::sqrt(2.0 / 144.0));
}

}  // namespace
}  // namespace lumulus::reference
