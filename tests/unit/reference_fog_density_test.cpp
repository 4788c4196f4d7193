#include "reference/fog_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "reference/fog_on_ray.h"
#include "reference/ground.h"
#include "reference/random.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

scene::FogMedium exponential(double falloff, const dvec3& direction = {0.0, 1.0, 0.0}) {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::exponential;
    medium.falloff = falloff;
    medium.direction = glm::normalize(direction);
    medium.offset = dvec3(3.0, -2.0, 5.0);
    return medium;
}

scene::FogMedium sphere(const dvec3& center, double radius) {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::sphere;
    medium.center = center;
    medium.radius = radius;
    return medium;
}

/// ϱ as docs/scene-format.md says.
double densityAt(const scene::FogMedium& medium, const dvec3& point) {
    switch (medium.kind) {
        case scene::MediumKind::homogeneous:
            return 1.0;
        case scene::MediumKind::exponential:
            return std::exp(-medium.falloff * glm::dot(point - medium.offset, medium.direction));
        case scene::MediumKind::ellipsoid:
            return glm::length((point - medium.center) / medium.halfSize) <= 1.0 ? 1.0 : 0.0;
        case scene::MediumKind::box:
            return glm::all(glm::lessThanEqual(glm::abs(point - medium.center), medium.halfSize)) ? 1.0 : 0.0;
        case scene::MediumKind::sphere:
            break;
    }
    const double distance = glm::distance(point, medium.center);
    return std::max(0.0, 1.0 - distance * distance / (medium.radius * medium.radius));
}

double quadrature(const scene::FogMedium& medium, const Ray& ray, double from, double to) {
    constexpr int steps = 200'000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        sum += densityAt(medium, ray.origin + (from + (to - from) * (i + 0.5) / steps) * ray.direction);
    }
    return sum * (to - from) / steps;
}

Ray ray(const dvec3& origin, const dvec3& direction) {
    return {origin, glm::normalize(direction)};
}

TEST(FogDensity, IntegralAgreesWithQuadrature) {
    const std::vector<scene::FogMedium> media{{},
                                              exponential(0.05),
                                              exponential(0.05, {1.0, -2.0, 0.5}),
                                              exponential(1e-9),
                                              sphere({4.0, 1.0, -20.0}, 15.0),
                                              sphere({0.0, 0.0, 0.0}, 30.0)};
    for (const scene::FogMedium& medium : media) {
        for (const dvec3& direction : {dvec3(0.1, 0.05, -1.0), dvec3(0.0, 1.0, 0.0), dvec3(0.0, -1.0, 0.2)}) {
            const Ray r = ray({1.0, 2.0, 3.0}, direction);
            const FogDensity density(medium, r, {2.0, 50.0});
            for (const double to : {10.0, 50.0, 80.0}) {
                const double expected = quadrature(medium, r, 2.0, std::min(to, 50.0));
                EXPECT_NEAR(density.pathTo(to), expected, 1e-8 * expected + 1e-12);
            }
            EXPECT_EQ(density.pathTo(1.0), 0.0) << "before the part begins";
        }
    }
}

TEST(FogDensity, TheInverseIsOne) {
    Random random(1, 0, 0);
    const std::vector<scene::FogMedium> media{
        {}, exponential(0.05), exponential(1e-9), exponential(10.0), sphere({4.0, 1.0, -20.0}, 15.0)};
    for (const scene::FogMedium& medium : media) {
        for (const dvec3& direction :
             {dvec3(0.1, 0.05, -1.0), dvec3(0.0, 1.0, 0.0), dvec3(0.1, -1.0, 0.2), dvec3(1.0, 0.0, 0.0)}) {
            const Ray r = ray({1.0, 2.0, 3.0}, direction);
            const FogDensity density(medium, r, {2.0, 50.0});
            const double whole = density.pathTo(infinity);
            EXPECT_EQ(density.metresTo(1.001 * whole + 1e-9), infinity);
            for (int i = 0; i < 100 && whole > 0.0; ++i) {
                const double path = random.uniform() * whole;
                EXPECT_NEAR(density.pathTo(density.metresTo(path)), path, 1e-7 * whole);
            }
        }
    }
}

/// The sphere along a chord at distance d from its centre: ∫ = (4/3) h³/R² with h² = R² − d².
TEST(FogDensity, AChordOfTheSphereHasItsClosedForm) {
    for (const double distance : {0.0, 1.0, 9.0, 9.999}) {
        for (const double away : {20.0, 1e6}) {
            const FogDensity density(sphere(dvec3(0.0), 10.0), ray({distance, 0.0, away}, {0.0, 0.0, -1.0}),
                                     {0.0, infinity});
            const double half = std::sqrt(100.0 - distance * distance);
            const double whole = 4.0 / 3.0 * half * half * half / 100.0;
            EXPECT_NEAR(density.pathTo(infinity), whole, 1e-9 * whole + 1e-12);
            EXPECT_NEAR(density.metresTo(0.5 * whole), away, 1e-6 * half) << "half of it lies before the middle";
        }
    }
    EXPECT_EQ(FogDensity(sphere(dvec3(0.0), 10.0), ray({10.0, 0.0, 20.0}, {0.0, 0.0, -1.0}), {0.0, 100.0}).pathTo(50.0),
              0.0);
}

/// From far above a steep layer, where ϱ at the eye is 0 in double, and from far below it.
TEST(FogDensity, SteepLayersNeitherOverflowNorVanish) {
    EXPECT_DOUBLE_EQ(
        FogDensity(exponential(0.01), ray({0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}), {0.0, infinity}).pathTo(infinity), 100.0);
    scene::FogMedium medium = exponential(10.0);
    medium.offset = dvec3(0.0);
    const FogDensity down(medium, ray({0.0, 1e4, 0.0}, {0.0, -1.0, 0.0}), {0.0, 1e5});
    EXPECT_NEAR(down.pathTo(1e4), 0.1, 1e-9);  // ∫ e^{−10 h} dh from 0
    EXPECT_NEAR(down.metresTo(0.1), 1e4, 1e-8);
    EXPECT_NEAR(down.metresTo(1e-300), 1e4 - (300.0 * std::log(10.0) - std::log(10.0)) / 10.0, 1e-6);
    EXPECT_GT(down.pathTo(1e5), 1e100);
    EXPECT_TRUE(std::isfinite(down.pathTo(1e5)));
    const FogDensity up(medium, ray({0.0, -1e4, 0.0}, {0.0, 1.0, 0.0}), {0.0, 1e5});
    EXPECT_TRUE(std::isfinite(up.pathTo(1.0)));
    EXPECT_EQ(up.metresTo(1.0), 0.0);
    const FogDensity level(medium, ray({0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}), {0.0, 1e5});
    EXPECT_NEAR(level.pathTo(100.0), 100.0 * std::exp(-10.0), 1e-12);
    const FogDensity nearlyLevel(medium, ray({0.0, 1.0, 0.0}, {1.0, 1e-13, 0.0}), {0.0, 1e5});
    EXPECT_NEAR(nearlyLevel.pathTo(100.0), 100.0 * std::exp(-10.0), 1e-12);
    EXPECT_NEAR(nearlyLevel.metresTo(1e-3), 1e-3 * std::exp(10.0), 1e-6);
}

/// Ellipsoid and box by quadrature, whose steps miss their edges by half a step.
TEST(FogDensity, EllipsoidAndBoxAgreeWithQuadrature) {
    scene::FogMedium medium;
    medium.center = {4.0, 1.0, -20.0};
    medium.halfSize = {15.0, 5.0, 9.0};
    for (const auto kind : {scene::MediumKind::ellipsoid, scene::MediumKind::box}) {
        medium.kind = kind;
        for (const dvec3& origin : {dvec3(1.0, 2.0, 3.0), dvec3(4.0, 2.0, -19.0)}) {
            for (const dvec3& direction : {dvec3(0.1, 0.05, -1.0), dvec3(0.0, 0.0, -1.0), dvec3(0.2, -0.1, -1.0)}) {
                const Ray r = ray(origin, direction);
                const FogOnRay fog(medium, r, std::nullopt);
                for (const double to : {10.0, 25.0, 80.0})
                    EXPECT_NEAR(fog.pathTo(to), quadrature(medium, r, 0.0, to), 1e-3);
                const double whole = fog.pathTo(infinity);
                EXPECT_NEAR(fog.pathTo(fog.metresTo(0.3 * whole)), 0.3 * whole, 1e-9);
                EXPECT_EQ(fog.metresTo(whole + 1e-6), infinity);
            }
        }
    }
}

scene::FogMedium layer(scene::MediumKind kind, double falloff, double bottom, double top) {
    scene::FogMedium medium = exponential(falloff);
    medium.kind = kind;
    medium.bottom = bottom;
    medium.top = top;
    return medium;
}

/// Along rays of all kinds, through level and round layers, whose edges the steps of 0.9 m miss by half a step.
double layerQuadrature(const scene::FogMedium& medium, const Ray& r, const std::optional<double>& planet, double to) {
    const auto density = [&](double t) {
        dvec3 point = r.origin + t * r.direction;
        if (planet) {
            const double height = glm::distance(point, {0.0, *planet - planetRadius, 0.0}) - planetRadius + *planet;
            point = dvec3(0.0, height, 0.0);
        }
        if (point.y < medium.bottom || point.y > medium.top) return 0.0;
        return densityAt(medium, point);
    };
    constexpr int steps = 100'000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += density(to * (i + 0.5) / steps);
    return sum * to / steps;
}

TEST(FogOnRay, LayersAgreeWithQuadrature) {
    const scene::FogMedium media[] = {layer(scene::MediumKind::homogeneous, 0.0, 130.0, 400.0),
                                      layer(scene::MediumKind::exponential, 0.004, 100.0, 700.0),
                                      layer(scene::MediumKind::exponential, 0.05, 100.0, infinity)};
    Random random(2, 0, 0);
    for (const scene::FogMedium& medium : media) {
        for (const std::optional<double>& planet : {std::optional<double>{}, std::optional(100.0)}) {
            for (const double height : {101.0, 300.0, 2000.0}) {
                for (const dvec3& direction :
                     {dvec3(0.1, 1.0, 0.3), dvec3(1.0, 0.01, 0.0), dvec3(1.0, 0.0, 0.2), dvec3(1.0, -0.02, 0.0)}) {
                    const Ray r = ray({40.0, height, -20.0}, direction);
                    const FogOnRay fog(medium, r, planet);
                    const double to = 90e3, expected = layerQuadrature(medium, r, planet, to);
                    EXPECT_NEAR(fog.pathTo(to), expected, 1e-4 * expected + 1.0) << height << ' ' << direction.y;
                    const double whole = fog.pathTo(infinity);
                    for (int i = 0; i < 20 && whole > 0.0 && whole < 1e9; ++i) {
                        const double path = random.uniform() * whole;
                        EXPECT_NEAR(fog.pathTo(fog.metresTo(path)), path, 1e-6 * whole);
                    }
                }
            }
        }
    }
}

/// Above a planet, straight up and along the horizon: 1/b, and √(π R / 2b) for a falloff that is short beside the
/// radius (Chapman), within the next term of its series.
TEST(FogOnRay, AFalloffAboveAPlanetHasItsLimits) {
    for (const double falloff : {1e-3, 0.1}) {
        const scene::FogMedium medium = layer(scene::MediumKind::exponential, falloff, -2.0, infinity);
        const FogOnRay up(medium, ray({3.0, -2.0, 5.0}, {0.0, 1.0, 0.0}), -2.0);
        EXPECT_NEAR(up.pathTo(infinity), 1.0 / falloff, 1e-6 / falloff);
        const FogOnRay level(medium, ray({0.0, -2.0, 0.0}, {1.0, 0.0, 0.0}), -2.0);
        const double x = falloff * planetRadius, chapman = std::sqrt(0.5 * glm::pi<double>() * planetRadius / falloff);
        EXPECT_NEAR(level.pathTo(infinity), chapman * (1.0 + 3.0 / (8.0 * x)), chapman * 1e-6);
    }
}

}  // namespace
}  // namespace lumulus::reference
