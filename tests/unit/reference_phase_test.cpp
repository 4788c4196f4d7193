#include "reference/phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "support/deviation.h"

namespace lumulus::reference {
namespace {

using scene::Phase;
using scene::PhaseModel;

struct Case {
    const char* name;
    Phase phase;
};

const Case cases[] = {
    {"isotropic", {PhaseModel::henyeyGreenstein, 0.0, 20.0}},
    {"forward", {PhaseModel::henyeyGreenstein, 0.85, 20.0}},
    {"backward", {PhaseModel::henyeyGreenstein, -0.6, 20.0}},
    {"narrow", {PhaseModel::henyeyGreenstein, 0.9999, 20.0}},
    {"schlick", {PhaseModel::schlick, 0.7, 20.0}},
    {"schlickBackward", {PhaseModel::schlick, -0.4, 20.0}},
    {"rayleigh", {PhaseModel::rayleigh, 0.0, 20.0}},
    {"hazy", {PhaseModel::hazy, 0.0, 20.0}},
    {"murky", {PhaseModel::murky, 0.0, 20.0}},
    {"droplet", {PhaseModel::droplet, 0.0, 10.0}},
};

/// ∫ f dx over [a, b] by midpoints in log x, where narrow lobes at 0 are wide.
template <typename Function>
double integral(double a, double b, const Function& f) {
    constexpr int steps = 4000;
    const double from = std::log(a + 1e-15), width = std::log(b + 1e-15) - from;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double x = std::exp(from + width * (i + 0.5) / steps);
        sum += f(x) * x * width / steps;
    }
    return sum;
}

/// ∫ p dω over 1 − cos θ from a to b; the backward half from its own end.
double share(const PhaseFunction& phase, double a, double b) {
    double sum = 0.0;
    if (a < 1.0) sum += integral(a, std::min(b, 1.0), [&](double x) { return phase.evaluate(x); });
    if (b > 1.0) sum += integral(2.0 - b, 2.0 - std::max(a, 1.0), [&](double x) { return phase.evaluate(2.0 - x); });
    return 2.0 * M_PI * sum;
}

class EveryPhase : public testing::TestWithParam<Case> {};

TEST_P(EveryPhase, IsNormalised) {
    EXPECT_NEAR(share(PhaseFunction(GetParam().phase), 0.0, 2.0), 1.0, 2e-5);
}

/// A chi-square test over 40 bins of equal width in log(1 − cos θ), as a normal deviate.
TEST_P(EveryPhase, SamplesWhatItEvaluates) {
    const PhaseFunction phase(GetParam().phase);
    constexpr int bins = 40, samples = 200'000;
    constexpr double low = 1e-7;
    std::vector<double> observed(bins), expected;
    const auto edge = [](int i) { return i == 0 ? 0.0 : low * std::pow(2.0 / low, static_cast<double>(i) / bins); };
    Random random(5, 0, 0);
    for (int i = 0; i < samples; ++i) {
        const double x = phase.sample(random);
        ASSERT_GE(x, 0.0);
        ASSERT_LE(x, 2.0);
        const double place = x <= low ? 0.0 : bins * std::log(x / low) / std::log(2.0 / low);
        observed[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>(place)))] += 1.0;
    }
    for (int i = 0; i < bins; ++i) expected.push_back(samples * share(phase, edge(i), edge(i + 1)));
    EXPECT_LT(test::chiSquareDeviation(observed, expected), 4.0);
}

INSTANTIATE_TEST_SUITE_P(Models, EveryPhase, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<Case>& row) { return std::string(row.param.name); });

TEST(Phase, HasTheTextbookValues) {
    const PhaseFunction hg({PhaseModel::henyeyGreenstein, 0.5, 20.0});
    EXPECT_NEAR(hg.evaluate(0.0), 0.75 / (4.0 * M_PI * 0.125), 1e-15);
    EXPECT_NEAR(hg.evaluate(1.0), 0.75 / (4.0 * M_PI * std::pow(1.25, 1.5)), 1e-15);
    EXPECT_NEAR(hg.evaluate(2.0), 0.75 / (4.0 * M_PI * std::pow(1.5, 3.0)), 1e-15);
    EXPECT_NEAR(PhaseFunction({PhaseModel::rayleigh, 0.0, 20.0}).evaluate(1.0), 3.0 / (16.0 * M_PI), 1e-15);
    EXPECT_NEAR(PhaseFunction({PhaseModel::hazy, 0.0, 20.0}).evaluate(0.0), 5.0 / (4.0 * M_PI), 1e-15);
    EXPECT_NEAR(PhaseFunction({PhaseModel::murky, 0.0, 20.0}).evaluate(0.0), 17.0 / (4.0 * M_PI), 1e-15);
}

TEST(Phase, RefusesSpikes) {
    EXPECT_THROW(PhaseFunction({PhaseModel::henyeyGreenstein, 1.0, 20.0}), InputError);
    EXPECT_THROW(PhaseFunction({PhaseModel::schlick, 0.95, 20.0}), InputError);
    EXPECT_THROW(PhaseFunction({PhaseModel::droplet, 0.0, 4.0}), InputError);
}

TEST(Turned, KeepsTheAngleAndTheLength) {
    Random random(1, 2, 3);
    glm::dvec3 direction(0.0, 0.0, -1.0);
    for (int i = 0; i < 1000; ++i) {
        const double oneMinusCos = 2.0 * random.uniform() * random.uniform();
        const glm::dvec3 next = turned(direction, oneMinusCos, random);
        EXPECT_NEAR(glm::length(next), 1.0, 1e-14);
        EXPECT_NEAR(oneMinusCosBetween(direction, next), oneMinusCos, 1e-13);
        direction = next;
    }
}

TEST(Turned, HasNoPreferredAzimuth) {
    Random random(9, 0, 0);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, -2.0, 0.5));
    glm::dvec3 sum(0.0);
    constexpr int samples = 100'000;
    for (int i = 0; i < samples; ++i) sum += turned(axis, 1.0, random);
    // each component has a variance of at most 1/2
    EXPECT_LT(glm::length(sum / double{samples}), 4.0 * std::sqrt(1.0 / samples));
}

TEST(Random, IsUniformAndKeyed) {
    Random random(1, 2, 3), same(1, 2, 3), other(1, 2, 4);
    EXPECT_EQ(random.uniform(), same.uniform());
    EXPECT_NE(random.uniform(), other.uniform());
    // over keys, as pixels use them: the first number of each
    double mean = 0.0, square = 0.0, product = 0.0, last = 0.5;
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) {
        const double u = Random(7, static_cast<std::uint64_t>(i / 100), static_cast<std::uint64_t>(i % 100)).uniform();
        mean += u / count;
        square += u * u / count;
        product += (u - 0.5) * (last - 0.5) / count;
        last = u;
    }
    EXPECT_NEAR(mean, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / count));
    EXPECT_NEAR(square, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / count));
    EXPECT_NEAR(product, 0.0, 4.0 / 12.0 / std::sqrt(count));
}

}  // namespace
}  // namespace lumulus::reference
