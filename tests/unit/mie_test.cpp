// Mie's theory against published values, and the tables of droplets that come from it.
#include "medium/mie.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "medium/inverse_cdf.h"
#include "medium/mie_sphere.h"
#include "medium/phase_function.h"
#include "medium/phase_note.h"
#include "medium/scattering_tables.h"
#include "medium/sun_axis.h"
#include "shared/phase_table.h"
#include "shared/rng.h"
#include "support/phase_cases.h"
#include "support/temporary_folder.h"

namespace lumulus::phase {
namespace {

using test::degree;
using test::pi;

struct Published {
    double size, index, efficiency, asymmetry;
};

// Bohren and Huffman 1983, appendix A (first row); Wiscombe 1979, tests 6 to 8
constexpr std::array published{Published{2.0 * pi * 0.525 / 0.6328, 1.55, 3.10543, 0.63314},
                               Published{10.0, 1.5, 2.8820, 0.742913}, Published{100.0, 1.5, 2.0944, 0.818246},
                               Published{1000.0, 1.5, 2.0139, 0.827882}};

TEST(MieSphere, EfficienciesAndAsymmetriesAsPublished) {
    for (const Published& row : published) {
        const MieCoefficients sphere = mieCoefficients(row.size, row.index);
        EXPECT_NEAR(scatteringEfficiency(sphere, row.size), row.efficiency, 5e-5) << row.size;
        EXPECT_NEAR(asymmetry(sphere), row.asymmetry, 5e-6) << row.size;
    }
    const double size = published[0].size;
    EXPECT_NEAR(backscatteringEfficiency(mieCoefficients(size, 1.55), size), 2.92534, 5e-5);
    // Rayleigh's limit: 8/3 x⁴ ((m²−1)/(m²+2))²
    const double ratio = (1.33 * 1.33 - 1.0) / (1.33 * 1.33 + 2.0);
    EXPECT_NEAR(scatteringEfficiency(mieCoefficients(0.01, 1.33), 0.01) / (8.0 / 3.0 * 1e-8 * ratio * ratio), 1.0,
                1e-4);
}

/// 2π ∫ f(θ) sin θ dθ by the trapezoid, which suits what has no steps.
template <class Function>
double overSphere(const Function& f, int steps) {
    double sum = 0.0;
    for (int i = 1; i < steps; ++i) {
        const double theta = pi * i / steps;
        sum += f(theta) * std::sin(theta);
    }
    return 2.0 * pi * pi / steps * sum;
}

TEST(MieSphere, IntensityIntegratesToTheEfficiency) {
    for (const double size : {1.0, 12.5, 80.0}) {
        const MieCoefficients sphere = mieCoefficients(size, 1.334);
        const double scattered = overSphere([&](double theta) { return mieIntensity(sphere, std::cos(theta)); }, 20000);
        EXPECT_NEAR(scattered / (pi * size * size) / scatteringEfficiency(sphere, size), 1.0, 1e-5);
        const double forward =
            overSphere([&](double theta) { return std::cos(theta) * mieIntensity(sphere, std::cos(theta)); }, 20000);
        EXPECT_NEAR(forward / scattered, asymmetry(sphere), 1e-5);
    }
}

TEST(Mie, IsTheMeanOverTheDistribution) {
    // many more spheres, one angle after the other, and Hansen's n(r) as it is written
    constexpr double radius = 4.0, variance = 0.08, wavelength = 0.56, index = 1.333;
    const TabulatedPhase table = miePhase(radius, variance, wavelength, index);
    const std::array angles{0.0, 1.0 * degree, 10.0 * degree, 60.0 * degree, 143.0 * degree, 178.0 * degree, pi};
    std::array<double, angles.size()> sums{};
    double all = 0.0;
    for (int i = 0; i < 1500; ++i) {
        const double r = 0.4 + 12.6 * (i + 0.5) / 1500.0, size = 2.0 * pi * r / wavelength;
        const double n = std::pow(r, (1.0 - 3.0 * variance) / variance) * std::exp(-r / (radius * variance));
        const MieCoefficients sphere = mieCoefficients(size, index);
        all += n * pi * size * size * scatteringEfficiency(sphere, size);
        for (std::size_t k = 0; k < angles.size(); ++k) sums[k] += n * mieIntensity(sphere, std::cos(angles[k]));
    }
    for (std::size_t k = 0; k < angles.size(); ++k)
        EXPECT_NEAR(table.evaluate(angles[k]) / (sums[k] / all), 1.0, angles[k] < 3.0 ? 0.02 : 0.04)
            << angles[k] / degree;
}

/// Where p is largest between two angles in degrees.
double peakOf(const PhaseFunction& p, double from, double to) {
    double best = from;
    for (double angle = from; angle <= to; angle += 0.02)
        if (p.evaluateAngle(angle * degree) > p.evaluateAngle(best * degree)) best = angle;
    return best;
}

scene::Phase droplets(double radius, double variance = 0.1) {
    scene::Phase phase;
    phase.model = scene::PhaseModel::mie;
    phase.effectiveRadius = radius;
    phase.effectiveVariance = variance;
    return phase;
}

TEST(Mie, CloudDropletsLookLikeCloudDroplets) {
    const PhaseFunction p(droplets(10.0));
    const double g = p.moments(2)[1];
    EXPECT_GT(g, 0.85);
    EXPECT_LT(g, 0.87);
    EXPECT_NEAR(peakOf(p, 125.0, 160.0), 142.0, 1.0);  // the fogbow
    // half of the light is diffracted or nearly so
    EXPECT_GT(p.forwardFraction(12.0 * degree), 0.52);
    EXPECT_LT(p.forwardFraction(12.0 * degree), 0.60);
    // the glory: bright against the sun, with a ring
    EXPECT_GT(p.evaluateAngle(pi), 3.0 * p.evaluateAngle(170.0 * degree));
    EXPECT_NEAR(peakOf(p, 177.0, 179.4), 178.4, 0.4);
    // smaller droplets have wider glories and bows farther from the sun's opposite
    const PhaseFunction small(droplets(5.0));
    EXPECT_LT(peakOf(small, 174.0, 178.8), 177.6);
    EXPECT_FALSE(hasBackwardPeak(p));
}

TEST(Mie, ColoursHaveTheOrderOfRainbows) {
    const std::vector<PhaseFunction> channels = phaseColours(droplets(10.0)).channels;
    ASSERT_EQ(channels.size(), 3U);
    // the outer rim of the bow is red, its inner one blue; a ring of the glory is red outside
    const auto ratio = [&](double angle) {
        return channels[0].evaluateAngle(angle * degree) / channels[2].evaluateAngle(angle * degree);
    };
    EXPECT_GT(ratio(135.0), 1.3);
    EXPECT_LT(ratio(141.0), 1.0);
    EXPECT_GT(ratio(177.6), 1.3);
    EXPECT_LT(ratio(178.9), 1.0);
    const PhaseFunction mean(droplets(10.0));
    for (const PhaseFunction& channel : channels) {
        EXPECT_NEAR(channel.moments(1)[0], 1.0, 1e-9);
        EXPECT_NEAR(channel.moments(2)[1], mean.moments(2)[1], 0.006);
    }
    EXPECT_TRUE(phaseColours(scene::Phase{}).channels.empty());
}

TEST(Mie, SizesAtTheEndsOfTheRange) {
    for (const double radius : {2.0, 50.0}) {
        const PhaseFunction p(droplets(radius));
        EXPECT_NEAR(p.moments(1)[0], 1.0, 1e-9);
        const double g = p.moments(2)[1];
        EXPECT_TRUE(g > 0.80 && g < 0.89) << radius << " " << g;
    }
    for (const double radius : {1.9, 50.1, std::nan("")}) EXPECT_THROW(PhaseFunction{droplets(radius)}, InputError);
    EXPECT_THROW(PhaseFunction(droplets(10.0, 0.0)), InputError);
}

TEST(Mie, SamplesWhatItEvaluates) {
    const PhaseFunction p(droplets(10.0));
    for (const double cut : {0.0, 15.0 * degree}) {
        const std::vector<float> table = makeInverseCdf(p, cut);
        constexpr int samples = 400000;
        constexpr std::array edges{0.0,   0.4,   0.8,   1.5,   3.0,   8.0,   15.0,  30.0,  60.0,  90.0,
                                   120.0, 137.0, 140.0, 143.0, 147.0, 160.0, 172.0, 177.0, 178.5, 180.0};
        std::array<double, edges.size() - 1> counts{};
        for (int i = 0; i < samples; ++i) {
            const shared::uvec4 key(static_cast<std::uint32_t>(i), 0U, 0U, shared::rngStream(77U, 0U, 0U));
            const shared::TableCell cell = shared::inverseCdfCell(shared::rngUniform4(key).x);
            const auto base = static_cast<std::size_t>(cell.base);
            const double x = static_cast<double>(glm::mix(table[base], table[base + 1], cell.fraction));
            const double angle = 2.0 * std::asin(std::sqrt(0.5 * x)) / degree;
            std::size_t bin = 0;
            while (bin + 1 < counts.size() && angle >= edges[bin + 1]) ++bin;
            counts[bin] += 1.0;
        }
        const double whole = 1.0 - p.forwardFraction(cut);
        for (std::size_t bin = 0; bin < counts.size(); ++bin) {
            const double low = std::max(edges[bin] * degree, cut), high = std::max(edges[bin + 1] * degree, cut);
            const double share = (p.forwardFraction(high) - p.forwardFraction(low)) / whole;
            const double deviation = std::sqrt(samples * share * (1.0 - share));
            EXPECT_NEAR(counts[bin], samples * share, 5.0 * deviation + 1.0) << edges[bin] << " cut " << cut;
        }
    }
}

TEST(Mie, TablesOfTheGpuHoldThreeColours) {
    const ScatteringTables tables =
        makeScatteringTables(droplets(10.0), 15.0 * degree, glm::dvec3(1.0), 4, 0.53 * degree);
    EXPECT_TRUE(tables.coloured);
    ASSERT_EQ(tables.phaseTable.size(), std::size_t{3} * shared::phaseTableSize);
    const std::vector<PhaseFunction> channels = phaseColours(droplets(10.0)).channels;
    for (const double angle : {60.0, 141.0, 150.0}) {
        const shared::ScatterAngle at =
            shared::angleFromOneMinusCos(static_cast<float>(test::oneMinusCosine(angle * degree)));
        const shared::TableCell cell =
            shared::tableCell(shared::angleToAxis(at, tables.angleScale), shared::phaseTableSize);
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t first = 3 * static_cast<std::size_t>(cell.base) + c;
            const double p = std::exp(
                static_cast<double>(glm::mix(tables.phaseTable[first], tables.phaseTable[first + 3], cell.fraction)));
            EXPECT_NEAR(p / channels[c].evaluateAngle(angle * degree), 1.0, 0.01) << angle;
        }
    }
    EXPECT_FALSE(makeScatteringTables(scene::Phase{}, 0.0, glm::dvec3(1.0), 4, 0.0).coloured);
}

TEST(TabulatedPhase, IsNormalisedAndHasTheMomentsOfWhatItHolds) {
    std::vector<double> angles, values;
    constexpr double g = 0.7;
    for (int i = 0; i <= 2000; ++i) {
        angles.push_back(pi * i / 2000.0);
        values.push_back(37.0 * std::pow(1.0 + g * g - 2.0 * g * std::cos(angles.back()), -1.5));
    }
    const TabulatedPhase table(angles, values);
    const std::vector<double> moments = table.moments(0.0, pi, 12);
    for (std::size_t l = 0; l < moments.size(); ++l) EXPECT_NEAR(moments[l], std::pow(g, static_cast<double>(l)), 2e-5);
    EXPECT_NEAR(table.factor(), (1.0 - g * g) / (4.0 * pi) / 37.0, 1e-6);
    EXPECT_NEAR(table.evaluate(0.0), (1.0 - g * g) / (4.0 * pi) / std::pow(1.0 - g, 3.0), 1e-4);
    EXPECT_EQ(table.evaluate(4.0), table.evaluate(pi));
}

TEST(PhaseTable, OfAFileIsNormalisedAndSaysSo) {
    const test::TemporaryFolder folder;
    scene::Phase phase;
    phase.model = scene::PhaseModel::table;
    phase.table = folder / "isotropic.txt";
    std::ofstream(phase.table) << "0 5\n180 5\n";
    const PhaseFunction p(phase);
    EXPECT_NEAR(p.evaluate(0.3), 0.25 / pi, 1e-12);
    EXPECT_NEAR(p.moments(2)[1], 0.0, 1e-12);
    EXPECT_NEAR(p.forwardFraction(0.5 * pi), 0.5, 1e-9);
    const auto note = normalisationNote(phase);
    ASSERT_TRUE(note.has_value());
    EXPECT_NE(note->find("multiplied by 0.0159155"), std::string::npos) << *note;
    std::ofstream(phase.table) << "0 0.0795774715\n180 0.0795774715\n";
    EXPECT_FALSE(normalisationNote(phase).has_value());
    // zeros are dark, and the tables of the GPU stay finite
    std::ofstream(phase.table) << "0 1\n90 0\n180 0\n";
    for (const float value : makeScatteringTables(phase, 0.2, glm::dvec3(1.0), 4, 0.01).phaseTable)
        EXPECT_TRUE(std::isfinite(value));
    std::ofstream(phase.table) << "0 1\n90 -1\n180 0\n";
    EXPECT_THROW(PhaseFunction{phase}, InputError);
}

}  // namespace
}  // namespace lumulus::phase
