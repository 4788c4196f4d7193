#include "medium/scattering_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "medium/axes.h"
#include "medium/single_scattering.h"
#include "medium/sun_disc.h"
#include "shared/phase_table.h"
#include "support/phase_cases.h"
#include "support/statistics.h"

namespace lumulus {
namespace {

using phase::PhaseFunction;
using phase::ScatteringTables;
using test::degree;
using test::oneMinusCosine;
using test::PhaseCase;
using test::pi;

constexpr double sunDiameter = 0.53 * degree;
constexpr double cut = 12.0 * degree;
const glm::dvec3 albedo(1.0, 0.95, 0.5);

shared::ScatterAngle angleOf(double theta) {
    return shared::ScatterAngle(static_cast<float>(oneMinusCosine(theta)),
                                static_cast<float>(oneMinusCosine(pi - theta)), static_cast<float>(std::sin(theta)));
}

double lookUpPhase(const ScatteringTables& tables, double theta) {
    const shared::TableCell cell =
        shared::tableCell(shared::angleToAxis(angleOf(theta), tables.angleScale), shared::phaseTableSize);
    const auto base = static_cast<std::size_t>(cell.base);
    return std::exp(static_cast<double>(glm::mix(tables.phaseTable[base], tables.phaseTable[base + 1], cell.fraction)));
}

/// H or K as a shader looks it up: bilinear, times the decay.
double lookUpSingleScattering(const ScatteringTables& tables, const std::vector<float>& table, double tau, double theta,
                              int channel) {
    const shared::TableCell angle =
        shared::tableCell(shared::angleToAxis(angleOf(theta), tables.angleScale), shared::singleScatterAngleCount);
    const shared::TableCell depth =
        shared::tableCell(shared::tauToAxis(static_cast<float>(tau), tables.tauMaximum), shared::singleScatterTauCount);
    const auto entry = [&](int a, int t) {
        return table[static_cast<std::size_t>(shared::singleScatterIndex(angle.base + a, depth.base + t) + channel)];
    };
    const float value = glm::mix(glm::mix(entry(0, 0), entry(0, 1), depth.fraction),
                                 glm::mix(entry(1, 0), entry(1, 1), depth.fraction), angle.fraction);
    return static_cast<double>(value * std::exp(-tables.extinctionScale[channel] * static_cast<float>(tau)));
}

struct Pair {
    double h = 0.0;
    double k = 0.0;
};

/// The formulas as they are written.
Pair sumSingleScattering(const phase::SingleScatteringSeries& series, double tau, double theta, double omega) {
    Pair sums;
    double before = 0.0;
    double legendre = 1.0;
    for (std::size_t i = 0; i < series.inside.size(); ++i) {
        const double l = static_cast<double>(i);
        const double term = (2.0 * l + 1.0) / (4.0 * pi) * series.disc[i] * std::exp(-tau) *
                            std::expm1(omega * series.inside[i] * tau) * legendre;
        sums.h += term * series.inside[i];
        sums.k += term * series.outside[i];
        const double next = ((2.0 * l + 1.0) * std::cos(theta) * legendre - l * before) / (l + 1.0);
        before = legendre;
        legendre = next;
    }
    return sums;
}

std::vector<PhaseCase> tableCases() {
    std::vector<PhaseCase> cases = test::tableCases();
    for (const double g : {-0.85, -0.3, 0.0, 0.6, 0.85, 0.99}) {
        cases.push_back(test::hgCase(g));
    }
    return cases;
}

class Tables : public ::testing::TestWithParam<PhaseCase> {
  protected:
    const scene::Phase phase_ = GetParam().phase;
    const PhaseFunction function_{phase_};
    const ScatteringTables tables_ = phase::makeScatteringTables(phase_, cut, albedo, 8, sunDiameter);
};

TEST_P(Tables, FractionsAndMoments) {
    EXPECT_NEAR(static_cast<double>(tables_.forwardFraction), function_.forwardFraction(cut), 1e-7);
    EXPECT_FLOAT_EQ(tables_.forwardFraction + tables_.scatterFraction, 1.0F);
    ASSERT_EQ(tables_.bandMoments.size(), 8U);
    EXPECT_FLOAT_EQ(tables_.bandMoments[0], 1.0F);
    const double turn = 1.0 - function_.forwardFraction(cut);
    for (unsigned l = 0; l < 8; ++l) {
        const double moment = test::integrateSphere(
            [&](double theta) { return function_.evaluateAngle(theta) * std::legendre(l, std::cos(theta)); }, cut, pi,
            function_.lobeWidth());
        if (!tables_.axisTable.empty() && l >= 3) {
            EXPECT_EQ(tables_.bandMoments[l], 0.0F) << "rings take it over, l = " << l;
            continue;
        }
        EXPECT_NEAR(static_cast<double>(tables_.bandMoments[l]), moment / turn, 1e-6) << "l = " << l;
    }
    EXPECT_EQ(tables_.analyticHg, phase_.model == scene::PhaseModel::henyeyGreenstein);
    EXPECT_EQ(tables_.inverseCdf.empty(), tables_.analyticHg);
    EXPECT_NEAR(static_cast<double>(tables_.g), function_.moments(2)[1], 1e-6);
}

TEST_P(Tables, PhaseTableIsThePhaseFunctionAveragedOverTheDisc) {
    for (int i = 0; i < 500; ++i) {
        const double theta = phase::axisToAngle((i + 0.37) / 500.0, function_.lobeWidth());
        const double exact = phase::averageOverDisc(function_, theta, 0.5 * sunDiameter);
        EXPECT_NEAR(lookUpPhase(tables_, theta), exact, 2e-4 * exact) << "theta " << theta;
    }
    const double whole = test::integrateSphere([&](double theta) { return lookUpPhase(tables_, theta); }, 0.0, pi,
                                               0.1 * function_.lobeWidth());
    EXPECT_NEAR(whole, 1.0, 1e-4);
}

/// At the middles of the cells, the worst places: errors relative to the source that H and K are added to, at its peak
/// and, in the mean, in the same direction. (H and K each have a step at θc, as wide as the lobe or the sun.)
TEST_P(Tables, SingleScatteringAgreesWithTheSeries) {
    const phase::SingleScatteringSeries series = phase::makeSingleScatteringSeries(function_, cut, 0.5 * sunDiameter);
    for (const int row : {0, 1, 5, 20, 40}) {
        const double tau = phase::axisToTau((row + 0.5) / (shared::singleScatterTauCount - 1),
                                            static_cast<double>(tables_.tauMaximum));
        for (int channel = 0; channel < 3; ++channel) {
            double peak = 0.0;
            double worst = 0.0;
            test::RunningMean local;
            for (int column = 0; column < shared::singleScatterAngleCount - 1; column += 10) {
                const double theta = phase::axisToAngle((column + 0.5) / (shared::singleScatterAngleCount - 1),
                                                        static_cast<double>(tables_.angleScale));
                const Pair exact = sumSingleScattering(series, tau, theta, albedo[channel]);
                const double h = lookUpSingleScattering(tables_, tables_.singleScatterH, tau, theta, channel);
                const double k = lookUpSingleScattering(tables_, tables_.singleScatterK, tau, theta, channel);
                const double source = lookUpPhase(tables_, theta) * std::exp(-tau) + exact.h + exact.k;
                const double error = std::abs(h - exact.h) + std::abs(k - exact.k);
                peak = std::max(peak, source);
                worst = std::max(worst, error);
                local.add(error / (source + 1e-30));  // what is below the smallest float is black
            }
            EXPECT_LT(worst, 1e-3 * peak + 1e-30) << "tau " << tau << ", albedo " << albedo[channel];
            EXPECT_LT(local.mean(), 2e-3) << "tau " << tau << ", albedo " << albedo[channel];
        }
    }
}

/// Only l = 0 is left of an integral over the sphere; all of it is what f does not count as extinction.
TEST_P(Tables, SingleScatteringConservesEnergy) {
    const double f = function_.forwardFraction(cut);
    for (const double tau : {0.1, 1.0, 7.0}) {
        for (int channel = 0; channel < 3; ++channel) {
            const auto integrate = [&](const std::vector<float>& table) {
                return test::integrateSphere(
                    [&](double theta) { return lookUpSingleScattering(tables_, table, tau, theta, channel); }, 0.0, pi,
                    0.1 * function_.lobeWidth());
            };
            const double h = integrate(tables_.singleScatterH);
            const double k = integrate(tables_.singleScatterK);
            const double bracket = std::exp(-tau) * std::expm1(albedo[channel] * f * tau);
            EXPECT_NEAR(h, f * bracket, 2e-3 * f * bracket) << tau;
            EXPECT_NEAR(k, (1.0 - f) * bracket, 2e-3 * (1.0 - f) * bracket) << tau;
            const double all = std::exp(-tau) + h + k;
            EXPECT_NEAR(all, std::exp(-(1.0 - albedo[channel] * f) * tau), 2e-3 * all) << tau;
        }
    }
}

TEST_P(Tables, SingleScatteringVanishesWithoutDepthOrAlbedo) {
    for (const double theta : {0.0, 0.1, 1.0, pi}) {
        EXPECT_EQ(lookUpSingleScattering(tables_, tables_.singleScatterH, 0.0, theta, 0), 0.0);
        EXPECT_EQ(lookUpSingleScattering(tables_, tables_.singleScatterK, 0.0, theta, 0), 0.0);
    }
    const ScatteringTables black = phase::makeScatteringTables(phase_, cut, glm::dvec3(0.0), 4, sunDiameter);
    EXPECT_EQ(*std::max_element(black.singleScatterH.begin(), black.singleScatterH.end()), 0.0F);
    EXPECT_EQ(*std::max_element(black.singleScatterK.begin(), black.singleScatterK.end()), 0.0F);
}

INSTANTIATE_TEST_SUITE_P(Phase, Tables, ::testing::ValuesIn(tableCases()));

TEST(SingleScattering, FirstOrderIsTheForwardLobeConvolvedWithItself) {
    // straight ahead: ∫_θ<θc p² dω, times ωτ; a point sun, whose series is the slowest
    const PhaseFunction p(test::hgCase(0.85).phase);
    const phase::SingleScatteringSeries series = phase::makeSingleScatteringSeries(p, cut, 0.0);
    const double squared = test::integrateSphere(
        [&](double theta) { return p.evaluateAngle(theta) * p.evaluateAngle(theta); }, 0.0, cut, p.lobeWidth());
    const double tau = 1e-6;
    const Pair found = sumSingleScattering(series, tau, 0.0, 0.9);
    EXPECT_NEAR(found.h / (0.9 * tau), squared, 3e-4 * squared);
    EXPECT_NEAR(found.k / (0.9 * tau), 0.0, 3e-4 * squared);
}

TEST(SingleScattering, NothingWithoutACut) {
    const ScatteringTables tables = phase::makeScatteringTables(test::hgCase(0.85).phase, 0.0, albedo, 6, sunDiameter);
    EXPECT_TRUE(tables.singleScatterH.empty());
    EXPECT_TRUE(tables.singleScatterK.empty());
    EXPECT_EQ(tables.forwardFraction, 0.0F);
    EXPECT_EQ(tables.scatterFraction, 1.0F);
    for (std::size_t l = 0; l < 6; ++l) {
        EXPECT_NEAR(static_cast<double>(tables.bandMoments[l]), std::pow(0.85, static_cast<double>(l)), 1e-7);
    }
}

TEST(SingleScattering, SharpestLobesStayFinite) {
    for (const double g : {-0.9999, 0.9999}) {
        const ScatteringTables tables =
            phase::makeScatteringTables(test::hgCase(g).phase, cut, glm::dvec3(1.0), 6, sunDiameter);
        for (const std::vector<float>* table :
             {&tables.singleScatterH.values(), &tables.singleScatterK.values(), &tables.phaseTable.values()}) {
            EXPECT_TRUE(std::all_of(table->begin(), table->end(), [](float x) { return std::isfinite(x); })) << g;
        }
        EXPECT_GT(tables.scatterFraction, 0.0F);
        EXPECT_FLOAT_EQ(tables.bandMoments[0], 1.0F);
    }
}

TEST(SunDisc, MomentsAreThoseOfADisc) {
    const double radius = 2.0 * degree;
    const std::vector<double> moments = phase::discMoments(radius, 200);
    const double solidAngle = 2.0 * pi * oneMinusCosine(radius);
    for (const unsigned l : {0U, 1U, 7U, 60U, 199U}) {
        const double exact =
            test::integrateSphere([l](double theta) { return std::legendre(l, std::cos(theta)); }, 0.0, radius, 0.01) /
            solidAngle;
        EXPECT_NEAR(moments[l], exact, 1e-10) << "l = " << l;
    }
}

TEST(SunDisc, AverageAgreesWithTheSeries) {
    const PhaseFunction p(test::hgCase(0.9).phase);
    const double radius = 3.0 * degree;
    const std::vector<double> chi = p.moments(400);
    const std::vector<double> disc = phase::discMoments(radius, 400);
    for (const double theta : {0.0, 1.0 * degree, 3.0 * degree, 3.5 * degree, 20.0 * degree, 100.0 * degree, pi}) {
        double sum = 0.0;
        for (unsigned l = 0; l < 400; ++l) {
            sum += (2.0 * l + 1.0) / (4.0 * pi) * chi[l] * disc[l] * std::legendre(l, std::cos(theta));
        }
        EXPECT_NEAR(phase::averageOverDisc(p, theta, radius), sum, 1e-8 * sum + 1e-12) << theta;
        EXPECT_EQ(phase::averageOverDisc(p, theta, 0.0), p.evaluateAngle(theta));
    }
}

TEST(SunDisc, ANarrowLobeBecomesTheDisc) {
    const PhaseFunction p(test::hgCase(0.9999).phase);
    const double radius = 0.5 * sunDiameter;
    const double solidAngle = 2.0 * pi * oneMinusCosine(radius);
    EXPECT_NEAR(phase::averageOverDisc(p, 0.0, radius) * solidAngle, p.forwardFraction(radius), 1e-10);
    // on the edge nearly half of the lobe is inside
    EXPECT_NEAR(phase::averageOverDisc(p, radius, radius) * solidAngle, 0.5, 0.03);
    const double whole =
        test::integrateSphere([&](double theta) { return phase::averageOverDisc(p, theta, radius); }, 0.0, pi, 2e-4);
    EXPECT_NEAR(whole, 1.0, 1e-3);
}

}  // namespace
}  // namespace lumulus
