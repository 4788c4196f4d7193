// ∫ϱ, spread and light of the analytic media against quadrature in double, and what must stay finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "fog/screen/spread.h"
#include "medium/fog_media.h"
#include "shared/fog.h"

namespace lumulus::fog {
namespace {

using scene::MediumKind;

double integral(const std::function<double(double)>& f, double begin, double end) {
    // Simpson's rule, fine enough for every case below
    constexpr int steps = 20000;
    const double h = (end - begin) / steps;
    double sum = f(begin) + f(end);
    for (int i = 1; i < steps; ++i) sum += (i % 2 == 0 ? 2.0 : 4.0) * f(begin + i * h);
    return sum * h / 3.0;
}

double density(const scene::FogMedium& m, const glm::dvec3& x) {
    if (m.kind == MediumKind::exponential) return std::exp(-m.falloff * glm::dot(x - m.offset, m.direction));
    if (m.kind == MediumKind::sphere) return std::max(0.0, 1.0 - std::pow(glm::length(x - m.center) / m.radius, 2));
    return 1.0;
}

double computed(const scene::FogMedium& m, const glm::dvec3& eye, const glm::dvec3& direction, double distance,
                double sky = 1e9) {
    scene::Fog fog;
    fog.media = {m};
    const shared::FogMedium medium = mediaAround(fog, eye).front();
    return static_cast<double>(shared::densityIntegral(medium, glm::vec3(0.0F), glm::vec3(direction),
                                                       static_cast<float>(distance), static_cast<float>(sky)));
}

scene::FogMedium exponential(double falloff) {
    scene::FogMedium m;
    m.kind = MediumKind::exponential;
    m.falloff = falloff;
    m.direction = glm::normalize(glm::dvec3(0.2, 1.0, -0.1));
    m.offset = {3.0, 20.0, -5.0};
    return m;
}

TEST(FogMedia, ExponentialIsTheIntegral) {
    for (const double falloff : {1e-9, 1e-4, 0.01, 0.3}) {
        const scene::FogMedium m = exponential(falloff);
        for (const glm::dvec3& towards : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0),
                                          glm::dvec3(-2, 0.1, 1), glm::dvec3(1, -0.001, 2)}) {
            const glm::dvec3 direction = glm::normalize(towards), eye(10.0, 50.0, 7.0);
            for (const double distance : {0.0, 1e-3, 1.0, 90.0}) {
                const double expected =
                    integral([&](double t) { return density(m, eye + t * direction); }, 0.0, distance);
                EXPECT_NEAR(computed(m, eye, direction, distance), expected, 1e-5 * expected)
                    << falloff << ' ' << distance;
            }
        }
    }
}

TEST(FogMedia, ExponentialFromTenKilometres) {
    scene::FogMedium m;
    m.kind = MediumKind::exponential;
    m.falloff = 0.01;
    const glm::dvec3 eye(0.0, 1e4, 0.0);
    // down to the ground, where ϱ = 1: (1 − e^−100) / .01; the same path beyond the layer, and level above it
    EXPECT_NEAR(computed(m, eye, {0, -1, 0}, 1e4), 100.0, 0.01);
    EXPECT_NEAR(computed(m, eye, {0, 1, 0}, 1e9), 100.0 * std::exp(-100.0), 1e-43);
    EXPECT_NEAR(computed(m, {0, 100, 0}, {1, 0, 0}, 1e3), 1e3 * std::exp(-1.0), 1e-3);
    m.falloff = 10.0;
    EXPECT_NEAR(computed(m, {0, 5, 0}, {0, -1, 0}, 5.0), 0.1, 1e-6);
    // far below the offset the density has no bound: the integral stays a number
    EXPECT_LE(computed(m, {0, 0, 0}, {0, -1, 0}, 1e5), 1.0001e20);
    EXPECT_EQ(computed(m, {0, -1e6, 0}, {0, -1, 0}, 0.0), 0.0);
}

TEST(FogMedia, SphereIsTheIntegral) {
    scene::FogMedium m;
    m.kind = MediumKind::sphere;
    m.center = {5.0, 0.0, -3.0};
    m.radius = 40.0;
    for (const glm::dvec3& eye : {glm::dvec3(0, 0, 0), glm::dvec3(30, 10, 0), glm::dvec3(100, 20, 7)}) {
        for (const glm::dvec3& target : {glm::dvec3(5, 0, -3), glm::dvec3(5, 30, -3), glm::dvec3(5, 39, -3)}) {
            const glm::dvec3 direction = glm::normalize(target - eye);
            for (const double distance : {1.0, 40.0, 400.0}) {
                const double expected =
                    integral([&](double t) { return density(m, eye + t * direction); }, 0.0, distance);
                EXPECT_NEAR(computed(m, eye, direction, distance), expected, 1e-4 * expected + 1e-5);
            }
        }
    }
}

TEST(FogMedia, SphereFromFarOutside) {
    scene::FogMedium m;
    m.kind = MediumKind::sphere;
    m.radius = 100.0;
    const glm::dvec3 eye(1e6, 0, 0);
    // through the middle ∫ (1 − s²/R²) ds = 4R/3; at half the radius (2/3 h³/R² · 2) with h² = 3/4 R²
    EXPECT_NEAR(computed(m, eye, {-1, 0, 0}, 1e10), 400.0 / 3.0, 0.1);
    const glm::dvec3 aside = glm::normalize(glm::dvec3(-1e6, 50, 0));
    EXPECT_NEAR(computed(m, eye, aside, 1e10), 4.0 / 3.0 * std::pow(0.75, 1.5) * 100.0, 0.5);
    EXPECT_EQ(computed(m, eye, {1, 0, 0}, 1e10), 0.0);
    // a sphere has an end of its own
    EXPECT_GT(computed(m, eye, {-1, 0, 0}, 1e10, 1e5), 133.0);
}

TEST(FogMedia, HomogeneousEndsAtTheSkyDistance) {
    EXPECT_EQ(computed({}, {}, {0, 0, 1}, 70.0), 70.0);
    EXPECT_EQ(computed({}, {}, {0, 0, 1}, 1e10, 5000.0), 5000.0);
}

shared::FogPath pathOf(float scattering, float absorption, float g, float distance) {
    shared::FogMedium medium{};
    medium.scattering = glm::vec3(scattering);
    medium.absorption = glm::vec3(absorption);
    medium.emission = glm::vec3(2.0F);
    medium.g = g;
    shared::FogPath path = shared::clearPath();
    shared::addMedium(path, medium, distance);
    return path;
}

TEST(FogMedia, SpreadIsPremozesFormula) {
    for (const double s : {1.0, 30.0, 500.0}) {
        for (const double absorption : {1e-4, 0.1}) {
            const double scattering = 0.3, g = 0.9;
            // Elek 2013, eq. 2: the deviation in metres; over the distance it is the angle
            const double w =
                std::sqrt(0.5 / (2.0 * absorption / (3.0 * s) + 4.0 / (s * s * s * scattering * (1.0 - g))));
            const shared::FogPath path = pathOf(0.3F, static_cast<float>(absorption), 0.9F, static_cast<float>(s));
            EXPECT_NEAR(std::sqrt(static_cast<double>(shared::spreadVariance(path))), w / s, 1e-5 * w / s);
        }
    }
}

TEST(FogMedia, LightIsConserved) {
    for (const float scattering : {0.0F, 1e-7F, 0.01F, 3.0F, 1e6F}) {
        for (const float absorption : {0.0F, 0.02F, 1e6F}) {
            const shared::FogPath path = pathOf(scattering, absorption, 0.9F, 25.0F);
            const glm::vec3 sum = shared::attenuatedShare(path) + shared::scatteredShare(path);
            EXPECT_NEAR(sum.x, std::exp(-25.0F * absorption), 2e-7F);
            const double depth = 25.0 * (static_cast<double>(scattering) + static_cast<double>(absorption));
            const double emitted = depth > 0.0 ? -50.0 * std::expm1(-depth) / depth : 50.0;
            EXPECT_NEAR(shared::emittedRadiance(path).x, emitted, 1e-5 * emitted);
        }
    }
}

TEST(FogMedia, EveryPathIsFinite) {
    for (const float c : {0.0F, 1e-9F, 1.0F, 1e6F}) {
        for (const float distance : {0.0F, 1e-6F, 1.0F, 1e20F}) {
            for (const float g : {-0.9999F, 0.0F, 0.9999F}) {
                for (const auto& [s, a] : {std::pair{c, 0.0F}, {0.0F, c}, {c, c}}) {
                    const shared::FogPath path = pathOf(s, a, g, distance);
                    EXPECT_TRUE(std::isfinite(shared::spreadVariance(path)));
                    EXPECT_TRUE(std::isfinite(shared::attenuatedShare(path).x));
                    EXPECT_TRUE(std::isfinite(shared::scatteredShare(path).x));
                    EXPECT_TRUE(std::isfinite(shared::emittedRadiance(path).x));
                }
            }
        }
    }
}

TEST(FogMedia, TheSunIsDimmedThroughTheLayerAbove) {
    scene::Fog fog;
    fog.media.resize(1);
    fog.media[0].kind = MediumKind::exponential;
    fog.media[0].falloff = 0.01;
    fog.media[0].scattering = {0.01, 0.02, 0.0};
    const glm::dvec3 share = sunTransmittance(fog, {0, 100, 0}, {0, 1, 0});
    EXPECT_NEAR(share.x, std::exp(-std::exp(-1.0)), 1e-5);
    EXPECT_NEAR(share.y, std::exp(-2.0 * std::exp(-1.0)), 1e-5);
    EXPECT_EQ(share.z, 1.0);
}

TEST(FogMedia, LargestSpreadIsABound) {
    Camera camera;
    camera.width = 64;
    camera.height = 48;
    camera.tanHalfFov = 0.5;
    scene::Fog fog;
    fog.media.resize(2);
    fog.media[0].scattering = glm::dvec3(0.01);
    fog.media[1] = exponential(0.05);
    fog.media[1].scattering = glm::dvec3(0.02);
    const double bound = largestSpread(fog, camera, 300.0);
    const std::vector<shared::FogMedium> media = mediaAround(fog, camera.position);
    for (const auto& [x, y] : {std::pair{0.5, 0.5}, {32.0, 24.0}, {32.0, 47.5}, {63.5, 47.5}}) {
        const glm::dvec3 direction = camera.ray(x, y).direction;
        shared::FogPath path = shared::clearPath();
        for (const shared::FogMedium& m : media)
            shared::addMedium(path, m, shared::densityIntegral(m, glm::vec3(0.0F), glm::vec3(direction), 300.0F, 1e5F));
        const double spread = std::sqrt(static_cast<double>(shared::spreadVariance(path))) * pixelsPerRadian(camera);
        EXPECT_LE(spread, bound * 1.0001);
    }
}

}  // namespace
}  // namespace lumulus::fog
