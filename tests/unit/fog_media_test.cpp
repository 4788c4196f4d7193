// ∫ϱ, spread and light of the analytic media against quadrature in double, and what must stay finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
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

scene::FogMedium layer(double bottom, double top) {
    scene::FogMedium m;
    m.bottom = bottom;
    m.top = top;
    return m;
}

/// A level layer is crossed for its thickness over the sine, from inside, from below, from above and from far away.
TEST(FogMedia, ALayerIsItsThicknessOverTheSine) {
    const scene::FogMedium m = layer(100.0, 130.0);
    for (const double away : {0.0, 1e3, 1e5, 1e7}) {
        for (const double sine : {1.0, 0.5, 1e-2, 1e-4}) {
            const glm::dvec3 up(std::sqrt(1.0 - sine * sine), sine, 0.0), down = -up;
            EXPECT_NEAR(computed(m, {5, 100 - away, 0}, up, 1e12) * sine / 30.0, 1.0, 2e-6) << away << ' ' << sine;
            EXPECT_NEAR(computed(m, {5, 130 + away, 0}, down, 1e12) * sine / 30.0, 1.0, 2e-6) << away << ' ' << sine;
            EXPECT_EQ(computed(m, {5, 100 - away, 0}, down, 1e12), 0.0);
            EXPECT_EQ(computed(m, {5, 130 + away, 0}, up, 1e12), 0.0);
            EXPECT_NEAR(computed(m, {5, 110, 0}, up, 1e12) * sine / 20.0, 1.0, 2e-6);
            EXPECT_NEAR(computed(m, {5, 110, 0}, down, 1e12) * sine / 10.0, 1.0, 2e-6);
        }
        // a path that ends within the layer, or before it
        EXPECT_NEAR(computed(m, {0, 100 - away, 0}, {0, 1, 0}, away + 12.0), 12.0, 1e-5 + 1e-7 * away);
        EXPECT_EQ(computed(m, {0, 99 - away, 0}, {0, 1, 0}, away), 0.0);
    }
    EXPECT_EQ(computed(m, {0, 110, 0}, {1, 0, 0}, 5e6), 5e6);
    EXPECT_EQ(computed(m, {0, 99, 0}, {1, 0, 0}, 5e6), 0.0);
    EXPECT_EQ(computed(m, {0, 131, 0}, {0, 0, -1}, 5e6), 0.0);
    EXPECT_EQ(computed(m, {0, 110, 0}, glm::normalize(glm::dvec3(1, 1e-9, 0)), 1e3), 1e3);
    EXPECT_EQ(computed(layer(7.0, 7.0), {0, 0, 0}, {0, 1, 0}, 1e3), 0.0) << "nothing is left above the ground";
}

TEST(FogMedia, ALayerHasAnEndOfItsOwn) {
    EXPECT_EQ(computed(layer(-10.0, 10.0), {}, {0, 0, 1}, 7000.0, 500.0), 7000.0);
    scene::FogMedium half = layer(-10.0, 1.0);
    half.top = std::numeric_limits<double>::infinity();
    EXPECT_EQ(computed(half, {}, {0, 1, 0}, 7000.0, 500.0), 500.0) << "endless upwards";
    EXPECT_NEAR(computed(half, {}, {0, -1, 0}, 7000.0, 500.0), 10.0, 1e-5);
    half.kind = MediumKind::exponential;
    EXPECT_NEAR(computed(half, {}, {0, 1, 0}, 1e10, 1.0), 100.0, 1e-3) << "it thins out upwards";
}

TEST(FogMedia, AnExponentialLayerIsTheIntegral) {
    for (const double falloff : {1e-9, 0.004, 0.3}) {
        for (scene::FogMedium m : {exponential(falloff), layer(0.0, 0.0)}) {
            m.kind = MediumKind::exponential;
            m.falloff = falloff;
            m.bottom = 35.0;
            m.top = 80.0;
            for (const glm::dvec3& eye : {glm::dvec3(10, 50, 7), glm::dvec3(10, -40, 7), glm::dvec3(10, 200, 7)}) {
                for (const glm::dvec3& towards : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0),
                                                  glm::dvec3(-2, 0.5, 1), glm::dvec3(1, -0.4, 0.3)}) {
                    const glm::dvec3 direction = glm::normalize(towards);
                    // within the layer, whose edges a rule of equal steps would miss by half a step
                    double first = 0.0, last = 1e9;
                    if (direction.y != 0.0) {
                        const double low = (m.bottom - eye.y) / direction.y, high = (m.top - eye.y) / direction.y;
                        first = std::max(0.0, std::min(low, high));
                        last = std::max(first, std::max(low, high));
                    } else if (eye.y < m.bottom || eye.y > m.top) {
                        last = first;
                    }
                    for (const double distance : {60.0, 500.0}) {
                        const double expected = integral([&](double t) { return density(m, eye + t * direction); },
                                                         std::min(first, distance), std::min(last, distance));
                        EXPECT_NEAR(computed(m, eye, direction, distance), expected, 3e-5 * expected + 1e-9)
                            << falloff << ' ' << eye.y << ' ' << direction.y << ' ' << distance;
                    }
                }
            }
        }
    }
}

/// Seen from 10 km above, a ground layer that is e times thinner every 10 m.
TEST(FogMedia, AGroundLayerFromFarAbove) {
    scene::FogMedium m = layer(-300.0, 0.0);
    m.kind = MediumKind::exponential;
    m.falloff = 0.1;
    m.offset.y = -300.0;
    m.top = std::numeric_limits<double>::infinity();
    for (const double sine : {1.0, 0.1, 1e-3}) {
        const glm::dvec3 down(std::sqrt(1.0 - sine * sine), -sine, 0.0);
        EXPECT_NEAR(computed(m, {0, 1e4, 0}, down, 1e10) * sine, 10.0, 5e-3) << sine;
        EXPECT_NEAR(computed(m, {0, -300, 0}, {down.x, sine, 0.0}, 1e10) * sine, 10.0, 1e-4) << sine;
    }
}

TEST(FogMedia, EllipsoidAndBoxAreTheirChords) {
    scene::FogMedium m;
    m.kind = MediumKind::ellipsoid;
    m.center = {5.0, 1.0, -3.0};
    m.halfSize = {40.0, 10.0, 20.0};
    const auto inside = [&](const glm::dvec3& x) {
        const glm::dvec3 unit = (x - m.center) / m.halfSize;
        return m.kind == MediumKind::box ? std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0
                                         : glm::length(unit) <= 1.0;
    };
    for (const MediumKind kind : {MediumKind::ellipsoid, MediumKind::box}) {
        m.kind = kind;
        for (const glm::dvec3& eye : {glm::dvec3(5, 1, -3), glm::dvec3(30, 5, 0), glm::dvec3(100, 20, 7)}) {
            for (const glm::dvec3& target : {glm::dvec3(6, 1, -3), glm::dvec3(5, 8, -3), glm::dvec3(5, 1, 30)}) {
                const glm::dvec3 direction = glm::normalize(target - eye);
                for (const double distance : {1.0, 40.0, 400.0}) {
                    const double expected =
                        integral([&](double t) { return inside(eye + t * direction) ? 1.0 : 0.0; }, 0.0, distance);
                    EXPECT_NEAR(computed(m, eye, direction, distance), expected, 0.05);
                }
            }
        }
        // from a thousand kilometres, and along an axis
        EXPECT_NEAR(computed(m, {5.0 + 1e6, 1.0, -3.0}, {-1, 0, 0}, 1e10), 80.0, 0.1);
        EXPECT_NEAR(computed(m, {5.0, 1.0, 40.0}, {0, 0, -1}, 1e10), 40.0, 1e-4);
        EXPECT_EQ(computed(m, {5.0, 12.0, 40.0}, {0, 0, -1}, 1e10), 0.0);
        EXPECT_EQ(computed(m, {5.0, 1.0, 40.0}, {0, 0, 1}, 1e10), 0.0);
    }
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

void expectSpreadBounded(const scene::Fog& fog, const glm::dvec3& eye) {
    Camera camera;
    camera.width = 64;
    camera.height = 48;
    camera.tanHalfFov = 0.5;
    camera.position = eye;
    const double bound = largestSpread(fog, camera, 300.0);
    const std::vector<shared::FogMedium> media = mediaAround(fog, camera.position);
    for (const auto& [x, y] : {std::pair{0.5, 0.5}, {32.0, 24.0}, {32.0, 47.5}, {63.5, 47.5}, {32.0, 20.0}}) {
        const glm::dvec3 direction = camera.ray(x, y).direction;
        shared::FogPath path = shared::clearPath();
        for (const shared::FogMedium& m : media)
            shared::addMedium(path, m, shared::densityIntegral(m, glm::vec3(0.0F), glm::vec3(direction), 300.0F, 1e5F));
        const double spread = std::sqrt(static_cast<double>(shared::spreadVariance(path))) * pixelsPerRadian(camera);
        EXPECT_LE(spread, bound * 1.0001) << eye.y << ' ' << x << ' ' << y;
    }
}

TEST(FogMedia, LargestSpreadIsABound) {
    scene::Fog fog;
    fog.media.resize(2);
    fog.media[0].scattering = glm::dvec3(0.01);
    fog.media[1] = exponential(0.05);
    fog.media[1].scattering = glm::dvec3(0.02);
    expectSpreadBounded(fog, glm::dvec3(0.0));
    // layers, from within, above and below
    for (scene::FogMedium& m : fog.media) {
        m.bottom = -10.0;
        m.top = 20.0;
        m.direction = {0.0, 1.0, 0.0};
    }
    for (const double eye : {0.0, 60.0, -40.0, 200.0}) {
        expectSpreadBounded(fog, {0.0, eye, 0.0});
        fog.media[1].direction.y *= -1.0;
        expectSpreadBounded(fog, {0.0, eye, 0.0});
    }
    fog.media[0].top = std::numeric_limits<double>::infinity();
    fog.media[1].kind = MediumKind::box;
    expectSpreadBounded(fog, {0.0, -12.0, 0.0});
}

}  // namespace
}  // namespace lumulus::fog
