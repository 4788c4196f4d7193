#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/deviation.h"
#include "surface/material/material.h"

namespace lumulus::material {
namespace {

using std::numbers::pi;

struct Case {
    std::string name;
    Material material;
};

std::vector<Case> cases() {
    std::vector<Case> all{{"lambert", {std::nullopt, 1.0, glm::dvec3(0.0), glm::dvec3(1.0), true}}};
    for (const double alpha : {0.0, 0.02, 0.1, 0.33, 0.6, 1.0}) {
        const std::string at = std::to_string(static_cast<int>(100 * alpha));
        all.push_back({"ggx" + at, {Microfacets::ggx, alpha, glm::dvec3(1.0), glm::dvec3(0.0), true}});
        all.push_back({"beckmann" + at, {Microfacets::beckmann, alpha, glm::dvec3(1.0), glm::dvec3(0.0), true}});
        all.push_back({"plastic" + at, {Microfacets::ggx, alpha, glm::dvec3(0.04), glm::dvec3(1.0), true}});
    }
    return all;
}

const EnergyTable& tableOf(const Material& material) {
    static const EnergyTable ggx(Microfacets::ggx), beckmann(Microfacets::beckmann);
    return material.facets == Microfacets::beckmann ? beckmann : ggx;
}

glm::dvec3 viewAt(double cosine) {
    return {std::sqrt(1.0 - cosine * cosine) * 0.6, std::sqrt(1.0 - cosine * cosine) * 0.8, cosine};
}

class EachMaterial : public testing::TestWithParam<Case> {};
/// Lobes that are wider than the cells in which samples are counted.
class EachWideLobe : public EachMaterial {};

std::vector<Case> wideCases() {
    std::vector<Case> all = cases();
    std::erase_if(all, [](const Case& one) { return one.material.alpha < 0.1; });
    return all;
}

/// Under light of radiance 1 from everywhere, a surface that absorbs nothing has the radiance 1.
TEST_P(EachMaterial, WhiteFurnace) {
    const Reflection reflection(GetParam().material, tableOf(GetParam().material));
    constexpr std::uint32_t points = 1U << 14U;
    for (const double cosine : {0.06, 0.2, 0.5, 0.83, 1.0}) {
        glm::dvec3 sum(0.0);
        for (std::uint32_t i = 0; i < points; ++i) {
            const LightSample sample = reflection.sample(viewAt(cosine), spreadPoint(i, points));
            if (sample.density > 0.0)
                sum += reflection.reflected(viewAt(cosine), sample.light) / sample.density / double{points};
        }
        EXPECT_NEAR(sum.x, 1.0, 0.01) << "n·v " << cosine;
        EXPECT_EQ(sum.x, sum.y);
    }
}

/// Without the compensation, which sees the view alone, light may be sent back the way it has come.
TEST_P(EachMaterial, Reciprocity) {
    Material material = GetParam().material;
    material.compensated = false;
    const Reflection reflection(material, tableOf(material));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 a = viewAt(0.01 + 0.98 * uniform(random));
        const double angle = 2.0 * pi * uniform(random), c = 0.01 + 0.98 * uniform(random), s = std::sqrt(1.0 - c * c);
        const glm::dvec3 b(s * std::cos(angle), s * std::sin(angle), c);
        const double there = reflection.reflected(a, b).x / b.z, back = reflection.reflected(b, a).x / a.z;
        EXPECT_NEAR(there, back, 1e-9 * std::max(there, back) + 1e-300);
    }
}

/// Samples lie where density() says: counts in cells of (cosine, azimuth) against its integral over them.
TEST_P(EachWideLobe, SamplesHaveTheirDensity) {
    const Material& material = GetParam().material;
    const Reflection reflection(material, tableOf(material));
    const glm::dvec3 view = viewAt(0.5);
    constexpr int rows = 16, columns = 24, count = 200000, fine = 24;
    std::vector<double> seen(rows * columns, 0.0), due(rows * columns, 0.0);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform;
    double drawn = 0.0;
    for (int i = 0; i < count; ++i) {
        const double u = uniform(random);
        const LightSample sample = reflection.sample(view, {u, uniform(random)});
        if (!(sample.density > 0.0)) continue;
        const double angle = std::atan2(sample.light.y, sample.light.x) / (2.0 * pi) + 0.5;
        const int row = std::min(static_cast<int>(sample.light.z * rows), rows - 1);
        seen[static_cast<std::size_t>(row * columns + std::min(static_cast<int>(angle * columns), columns - 1))] += 1.0;
        drawn += 1.0;
    }
    double total = 0.0;
    for (int y = 0; y < rows * fine; ++y)
        for (int x = 0; x < columns * fine; ++x) {
            const double c = (y + 0.5) / (rows * fine), s = std::sqrt(1.0 - c * c);
            const double angle = 2.0 * pi * ((x + 0.5) / (columns * fine) - 0.5);
            const double part = reflection.density(view, {s * std::cos(angle), s * std::sin(angle), c}) * 2.0 * pi /
                                (rows * columns * fine * fine);
            due[static_cast<std::size_t>((y / fine) * columns + x / fine)] += part * count;
            total += part;
        }
    EXPECT_NEAR(total, drawn / count, 4.0 * std::sqrt(total / count) + 2e-4);
    EXPECT_LT(std::abs(test::chiSquareDeviation(seen, due, 0)), 4.0);
}

INSTANTIATE_TEST_SUITE_P(Materials, EachMaterial, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(Materials, EachWideLobe, testing::ValuesIn(wideCases()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Material, NothingIsReflectedBelowTheSurface) {
    const Material material{Microfacets::ggx, 0.0, glm::dvec3(1.0), glm::dvec3(0.5), true};
    const Reflection reflection(material, tableOf(material));
    const glm::dvec3 up(0.0, 0.0, 1.0), level(1.0, 0.0, 0.0);
    for (const glm::dvec3& light : {level, -up}) {
        EXPECT_EQ(reflection.reflected(up, light), glm::dvec3(0.0));
        EXPECT_EQ(reflection.reflected(light, up), glm::dvec3(0.0));
        EXPECT_EQ(reflection.density(up, light), 0.0);
    }
}

/// Mean albedo of a mirror, Σ over the cosine: METHODS' 0.97, 0.70 and 0.41 were computed by another program.
TEST(Material, EnergyOfSingleReflection) {
    const EnergyTable table(Microfacets::ggx);
    for (const auto& [alpha, mean] : {std::pair{0.1, 0.97}, std::pair{0.5, 0.70}, std::pair{1.0, 0.41}}) {
        double sum = 0.0;
        for (int i = 0; i < 100; ++i) sum += table.at((i + 0.5) / 100, alpha).energy() * 2.0 * (i + 0.5) / 100 / 100;
        EXPECT_NEAR(sum, mean, 0.03) << alpha;
    }
}

TEST(Material, TableIsThatOfTheQuadrature) {
    for (const Microfacets kind : {Microfacets::ggx, Microfacets::beckmann}) {
        const EnergyTable table(kind);
        for (const double alpha : {0.01, 0.13, 0.4, 0.9})
            for (const double cosine : {0.05, 0.3, 0.7, 0.99}) {
                const SplitSum exact = splitSum(kind, cosine, alpha, 8192), told = table.at(cosine, alpha);
                EXPECT_NEAR(told.energy(), exact.energy(), 0.005) << alpha << " " << cosine;
                EXPECT_NEAR(told.scale, exact.scale, 0.005) << alpha << " " << cosine;
            }
    }
}

}  // namespace
}  // namespace lumulus::material
