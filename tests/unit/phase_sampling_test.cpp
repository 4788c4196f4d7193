#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>

#include "medium/axes.h"
#include "medium/inverse_cdf.h"
#include "shared/phase.h"
#include "shared/phase_table.h"
#include "shared/rng.h"
#include "support/angle_distribution.h"
#include "support/phase_cases.h"

namespace lumulus {
namespace {

using phase::PhaseFunction;
using shared::ScatterAngle;
using test::degree;
using test::oneMinusCosine;
using test::PhaseCase;
using test::pi;

constexpr int samples = 1000000;

using Sampler = std::function<ScatterAngle(float)>;

void expectDistribution(const PhaseFunction& p, double cut, const Sampler& sample) {
    test::AngleDistribution distribution(p, cut);
    for (int i = 0; i < samples; ++i) {
        const shared::uvec4 key(static_cast<std::uint32_t>(i), 0U, 0U, shared::rngStream(20240501U, 0U, 0U));
        distribution.add(sample(shared::rngUniform4(key).x));
    }
    distribution.expectAgreement();
    if (cut == 0.0) {
        const test::RunningMean& oneMinusCos = distribution.oneMinusCos();
        EXPECT_NEAR(oneMinusCos.mean(), 1.0 - p.moments(2)[1], 5.0 * oneMinusCos.standardError() + 1e-7);
    }
}

class SampleHg : public ::testing::TestWithParam<PhaseCase> {};

TEST_P(SampleHg, DistributionIsThatOfThePhaseFunction) {
    const PhaseFunction p(GetParam().phase);
    const auto g = static_cast<float>(GetParam().phase.g);
    expectDistribution(p, 0.0, [g](float u) { return shared::sampleHg(g, u, 1.0F); });
}

TEST_P(SampleHg, RestrictedBeyondTheCut) {
    const PhaseFunction p(GetParam().phase);
    const auto g = static_cast<float>(GetParam().phase.g);
    for (const double cut : {2.0 * degree, 12.0 * degree}) {
        const auto scatterFraction = static_cast<float>(1.0 - p.forwardFraction(cut));
        expectDistribution(p, cut, [=](float u) { return shared::sampleHg(g, u, scatterFraction); });
    }
}

INSTANTIATE_TEST_SUITE_P(Phase, SampleHg, ::testing::ValuesIn(test::hgCases()));

class SampleTable : public ::testing::TestWithParam<PhaseCase> {};

TEST_P(SampleTable, DistributionIsThatOfThePhaseFunction) {
    const PhaseFunction p(GetParam().phase);
    for (const double cut : {0.0, 12.0 * degree}) {
        const std::vector<float> table = phase::makeInverseCdf(p, cut);
        ASSERT_EQ(table.size(), static_cast<std::size_t>(shared::inverseCdfCells) + 1);
        EXPECT_EQ(table.front(), 2.0F);
        EXPECT_TRUE(std::is_sorted(table.rbegin(), table.rend()));
        expectDistribution(p, cut, [&table](float u) {
            const shared::TableCell cell = shared::inverseCdfCell(u);
            const auto base = static_cast<std::size_t>(cell.base);
            return shared::angleFromOneMinusCos(glm::mix(table[base], table[base + 1], cell.fraction));
        });
    }
}

INSTANTIATE_TEST_SUITE_P(Phase, SampleTable, ::testing::ValuesIn(test::tableCases()));

TEST(SampleHg, EndsOfTheUnitInterval) {
    constexpr float last = 1.0F - 1.0F / 16777216.0F;
    for (const float g : {-0.9999F, -0.5F, 0.0F, 1e-6F, 0.85F, 0.9999F}) {
        const ScatterAngle first = shared::sampleHg(g, 0.0F, 1.0F);
        const ScatterAngle end = shared::sampleHg(g, last, 1.0F);
        // u = 0 is opposite to the lobe, u → 1 the middle of it
        EXPECT_EQ(g < 0.0F ? first.onePlusCos : first.oneMinusCos, 2.0F) << g;
        EXPECT_LT(g < 0.0F ? end.onePlusCos : end.oneMinusCos, 3e-7F) << g;
        EXPECT_TRUE(std::isfinite(end.sinTheta) && std::isfinite(first.sinTheta)) << g;
    }
}

TEST(RotateDirection, KeepsItsLengthOverAMillionTurns) {
    shared::vec3 d(0.0F, 0.0F, 1.0F);
    double worst = 0.0;
    for (int i = 0; i < 1000000; ++i) {
        const shared::vec4 u = shared::rngUniform4(shared::uvec4(static_cast<std::uint32_t>(i), 0U, 0U, 1U));
        const float g = u.z < 0.5F ? 0.85F : 0.0F;
        d = shared::rotateDirection(d, shared::sampleHg(g, u.x, 1.0F), 6.28318531F * u.y);
        worst = std::max(worst, std::abs(glm::length(glm::dvec3(d)) - 1.0));
    }
    EXPECT_LT(worst, 3e-7);
}

TEST(RotateDirection, TurnsByTheAngleFromEveryDirection) {
    std::vector<shared::vec3> directions{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1e-4F, 0, 1}, {0, -1e-4F, -1}};
    for (int i = 0; i < 100; ++i) {
        const shared::vec4 u = shared::rngUniform4(shared::uvec4(static_cast<std::uint32_t>(i), 0U, 0U, 2U));
        directions.emplace_back(u.x - 0.5F, u.y - 0.5F, u.z - 0.5F);
    }
    for (const shared::vec3& raw : directions) {
        const shared::vec3 d = glm::normalize(raw);
        for (const double theta : {0.0, 1e-4, 1e-2, 0.5, pi / 2.0, 3.0, pi}) {
            const ScatterAngle angle{static_cast<float>(oneMinusCosine(theta)),
                                     static_cast<float>(oneMinusCosine(pi - theta)),
                                     static_cast<float>(std::sin(theta))};
            glm::dvec3 sum(0.0);
            for (int k = 0; k < 8; ++k) {
                const shared::vec3 turned = shared::rotateDirection(d, angle, static_cast<float>(k * pi / 4.0));
                const glm::dvec3 a = glm::normalize(glm::dvec3(d));
                const glm::dvec3 b = glm::normalize(glm::dvec3(turned));
                const double found = 2.0 * std::atan2(glm::length(a - b), glm::length(a + b));
                EXPECT_NEAR(found, theta, 1e-6);
                EXPECT_NEAR(glm::length(glm::dvec3(turned)), 1.0, 3e-7);
                sum += b;
            }
            // eight azimuths lie evenly about d
            EXPECT_LT(glm::length(sum - 8.0 * std::cos(theta) * glm::dvec3(d)), 1e-5);
        }
    }
}

TEST(ScatterAngle, BetweenVectorsKeepsSmallAngles) {
    const shared::vec3 a(0.0F, 0.0F, 1.0F);
    for (const float theta : {1e-4F, 1e-2F, 1.0F, 3.0F}) {
        const ScatterAngle angle = shared::angleBetween(a, {std::sin(theta), 0.0F, std::cos(theta)});
        const double exact = oneMinusCosine(static_cast<double>(theta));
        EXPECT_NEAR(static_cast<double>(angle.oneMinusCos), exact, 2e-3 * exact) << theta;
        EXPECT_NEAR(angle.sinTheta, std::sin(theta), 1e-6F) << theta;
    }
}

TEST(AngleAxis, GoesBothWays) {
    for (const double scale : {1e-4, 0.005, 0.15, 0.25}) {
        double before = -1.0;
        for (int i = 0; i <= 1000; ++i) {
            const double x = i / 1000.0;
            const double theta = phase::axisToAngle(x, scale);
            EXPECT_GT(theta, before);
            before = theta;
            const ScatterAngle angle{static_cast<float>(oneMinusCosine(theta)),
                                     static_cast<float>(oneMinusCosine(pi - theta)), 0.0F};
            EXPECT_NEAR(static_cast<double>(shared::angleToAxis(angle, static_cast<float>(scale))), x, 1e-6);
        }
        EXPECT_NEAR(phase::axisToAngle(0.0, scale), 0.0, 1e-12);
        EXPECT_NEAR(phase::axisToAngle(1.0, scale), pi, 1e-12);
    }
    for (const double tau : {0.0, 0.01, 1.0, 30.0}) {
        const float x = shared::tauToAxis(static_cast<float>(tau), 40.0F);
        EXPECT_NEAR(phase::axisToTau(static_cast<double>(x), 40.0), tau, 1e-5 * (1.0 + tau));
    }
    EXPECT_EQ(shared::tauToAxis(1000.0F, 40.0F), 1.0F);
}

}  // namespace
}  // namespace lumulus
